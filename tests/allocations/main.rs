//! A scene allocates nothing for what it does not state: no more than one that says there is none of it, and less
//! than one that states it so that it changes nothing.
//!
//! One test, so that nothing else allocates meanwhile; one thread, so that counts are the same every time.
#![allow(clippy::unwrap_used, unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use dpana::{Scene, Status, solve};
use serde_json::{Value, json};

/// Allocations so far.
static COUNT: AtomicUsize = AtomicUsize::new(0);

/// Allocations that threads other than the one at work may add, now and then.
const POOL: usize = 4;

/// The system's allocator, which is watched.
struct Watched;

// SAFETY: what it is asked for goes to the system's allocator as it is.
unsafe impl GlobalAlloc for Watched {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.fetch_add(1, Relaxed);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static WATCHED: Watched = Watched;

/// Allocations of solving a square that is pressed and dragged on a plane, or what a change makes of it.
fn square(change: impl FnOnce(&mut Value)) -> usize {
    let mut scene = json!({
        "bodies": [{
            "name": "square",
            "mesh": {"rectangle": {"x": [0, 1], "y": [0, 1], "cells": [24, 24]}},
            "model": "plane_strain",
            "materials": [{"young": 1000, "poisson": 0.3}],
            "supports": [{"group": "top", "displacement": [0.002, -0.01]}]
        }],
        "contacts": [{"group": "bottom", "friction": 0.3,
                      "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}}]
    });
    change(&mut scene);
    let scene = Scene::from_json(&scene.to_string(), "").unwrap();
    let before = COUNT.load(Relaxed);
    let solution = solve(&scene).unwrap();
    let found = COUNT.load(Relaxed) - before;
    assert_eq!(solution.status(), Status::Certified);
    found
}

/// Puts a value in place of what stands at a JSON pointer, or appends it to an array there.
fn put(at: &str, key: &str, value: Value) -> impl FnOnce(&mut Value) {
    move |scene| match scene.pointer_mut(at).unwrap() {
        Value::Array(all) => all.push(value),
        all => all[key] = value,
    }
}

fn a_plain_scene_allocates_less_than_one_that_states_features_which_change_nothing() {
    square(|_| {});
    let plain = square(|_| {});
    let body = "/bodies/0";
    let still = [
        square(put("", "rigid_bodies", json!([]))),
        square(put(body, "bolts", json!([]))),
        square(put(body, "foundation", json!([]))),
        square(put("/contacts/0", "gap", json!(0))),
    ];
    for found in still {
        assert!(
            found.abs_diff(plain) <= POOL,
            "what is stated to be none is none: {found}, plain {plain}"
        );
    }
    let held = |scene: &mut Value| {
        let contact = &mut scene["contacts"][0];
        let plane = contact.as_object_mut().unwrap().remove("obstacle").unwrap();
        contact["rigid_body"] = json!("floor");
        scene["rigid_bodies"] = json!([{"name": "floor", "surfaces": [plane], "reference": [0, 0],
                                       "displacement": [0, 0], "rotation": [0]}]);
    };
    let law = |scene: &mut Value| {
        let contact = &mut scene["contacts"][0];
        contact.as_object_mut().unwrap().remove("friction");
        contact["law"] = json!({"coulomb": {"friction": 0.3, "regions": {"bottom": 0.3}}});
    };
    let expanding = |scene: &mut Value| {
        scene["bodies"][0]["materials"][0]["expansion"] = json!(1e-5);
        scene["bodies"][0]["loads"] = json!([{"temperature": 0}]);
    };
    let bolt = json!([{"name": "bolt", "group": "body", "point": [0.5, 0.5], "axis": [0, 1], "shortening": 0}]);
    let spring = json!([{"group": "left", "normal": 1e-9}]);
    let neutral = [
        ("a held rigid body", square(held)),
        ("a law by region", square(law)),
        ("heat of nothing", square(expanding)),
        (
            "a bolt that is not shortened",
            square(put(body, "bolts", bolt)),
        ),
        (
            "springs of nothing",
            square(put(body, "foundation", spring)),
        ),
        (
            "a force of nothing",
            square(put(body, "loads", json!([{"body_force": [0, 0]}]))),
        ),
    ];
    for (what, found) in neutral {
        // Each needs arrays of its own, which a scene without it must not have.
        assert!(plain + POOL < found, "{what}: {found}, plain {plain}");
    }
}

#[test]
fn a_scene_allocates_nothing_for_what_it_does_not_state() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.unwrap()
        .install(a_plain_scene_allocates_less_than_one_that_states_features_which_change_nothing);
}
