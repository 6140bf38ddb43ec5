//! Pairs of surfaces that cannot touch as stated are refused, with the place and what is accepted.

use dpana::body::{Body, CellKind, Facet, Group};
use dpana::condensation::Condensed;
use dpana::contact::{ContactPair, ContactSurface, Opposite};
use dpana::scene::{MeshSource, SceneBody, SceneContact, SceneSurface};
use dpana::{Error, Scene, solve};

use crate::stacks::{block, body, certified, contact, hold, scene};

/// Two unit blocks, the upper one `gap` above the lower one and `beside` to the right, both held
/// at their backs.
fn blocks(kind: CellKind, gap: f64, beside: f64) -> Vec<SceneBody> {
    let up = kind.dimension() - 1;
    let mut bodies = Vec::new();
    for (name, low, back) in [("lower", 0.0, "bottom"), ("upper", 1.0 + gap, "top")] {
        let mut from = [0.0; 3];
        from[up] = low;
        if name == "upper" {
            from[0] = beside;
        }
        let mesh = block(kind, from, from.map(|x| x + 1.0), [3; 3]);
        let mut body = body(name, mesh, 1000.0, 0.3);
        for axis in 0..=up {
            body = hold(body, back, axis, 0.0);
        }
        bodies.push(body);
    }
    bodies
}

fn faces(own: &str, other: &str) -> Vec<SceneContact> {
    vec![contact(["upper", own], ["lower", other], 0.3)]
}

/// The message of a scene that must be refused, without its outer places.
fn refused(bodies: Vec<SceneBody>, contacts: Vec<SceneContact>) -> Error {
    solve(&scene(bodies, contacts)).unwrap_err()
}

fn says(error: &Error, parts: &[&str]) {
    let text = error.to_string();
    for part in parts {
        assert!(text.contains(part), "`{part}` is not in: {text}");
    }
}

#[test]
fn a_surface_is_not_dragged_along_another_body() {
    let mut faces = faces("bottom", "top");
    faces[0].dragged = true;
    let error = refused(blocks(CellKind::Quad4, 0.0, 0.0), faces);
    says(
        &error,
        &["contacts[0].dragged", "true beside `against`", "`obstacle`"],
    );
}

#[test]
fn bodies_deep_in_each_other_are_refused_with_the_place_and_the_depth() {
    for kind in CellKind::LINEAR {
        // A twentieth of the diagonal of the smaller side: 0.05, and 0.0707 in 3D.
        for depth in [0.08, 0.3, 0.7] {
            let error = refused(blocks(kind, -depth, 0.0), faces("bottom", "top"));
            let Error::Overlap {
                place,
                position,
                overlap,
                allowed,
            } = &error
            else {
                unreachable!("{error}");
            };
            assert_eq!(place, "contacts[0]");
            let up = kind.dimension() - 1;
            assert!((position[up] - 1.0 + depth).abs() < 1e-12, "{error}");
            assert!((overlap - depth).abs() < 1e-12, "{error}");
            let diagonal = if up == 1 { 1.0 } else { 2.0_f64.sqrt() };
            assert!((allowed - 0.05 * diagonal).abs() < 1e-12, "{error}");
            says(&error, &["overlap by", "expected at most"]);
        }
    }
}

#[test]
fn an_overlap_that_is_deep_only_in_its_middle_is_refused() {
    // The lower side of a lens, 0.2 deep in the block below it at its lowest point, not at its rim.
    for kind in [CellKind::Quad4, CellKind::Hex8] {
        let up = kind.dimension() - 1;
        let mut bodies = blocks(kind, 0.0, 0.0);
        let mut lens = block(kind, [0.0, 0.0, 0.0], [1.0; 3], [8; 3]);
        for at in &mut lens.nodes {
            let around = (0..up).map(|axis| (at[axis] - 0.5).powi(2)).sum::<f64>();
            at[up] += 1.0 - (1.0 - at[up]) * (0.2 - around);
        }
        bodies[1].mesh = MeshSource::Given(lens);
        let error = refused(bodies, faces("bottom", "top"));
        let Error::Overlap { overlap, .. } = error else {
            unreachable!("{error}");
        };
        assert!(overlap > 0.07 && overlap < 0.2, "{overlap}");
    }
}

#[test]
fn sides_that_never_face_each_other_are_refused() {
    for kind in CellKind::LINEAR {
        // Side by side, back to back, and one behind the other looking the same way.
        for (bodies, contacts) in [
            (blocks(kind, 0.1, 1.5), faces("bottom", "top")),
            (blocks(kind, 0.1, 0.0), faces("top", "bottom")),
            (blocks(kind, 0.1, 0.0), faces("top", "top")),
        ] {
            let error = refused(bodies, contacts);
            assert!(
                matches!(error, Error::NothingFacesOpposite { .. }),
                "{error}"
            );
            says(&error, &["contacts[0]", "outward normals"]);
        }
    }
}

#[test]
fn a_surface_with_itself_and_a_common_facet_are_refused() {
    for kind in CellKind::LINEAR {
        let mut bodies = blocks(kind, 0.1, 0.0);
        let pair = contact(["upper", "bottom"], ["upper", "bottom"], 0.0);
        let error = refused(bodies.clone(), vec![pair]);
        says(&error, &["contacts[0].opposite", "on both sides"]);

        let MeshSource::Given(mesh) = &mut bodies[1].mesh else {
            unreachable!();
        };
        let (Group::Facets(bottom), Group::Facets(left)) =
            (&mesh.groups["bottom"], &mesh.groups["left"])
        else {
            unreachable!();
        };
        let corner = [left.clone(), vec![bottom[0].clone()]].concat();
        mesh.groups.insert("corner".into(), Group::Facets(corner));
        let pair = contact(["upper", "bottom"], ["upper", "corner"], 0.0);
        says(
            &refused(bodies, vec![pair]),
            &["on both sides", "common facet"],
        );
    }
}

#[test]
fn names_of_nothing_are_refused_with_the_nearest_known_one() {
    let bodies = blocks(CellKind::Quad4, 0.0, 0.0);
    let with = |change: fn(&mut SceneContact)| {
        let mut pairs = faces("bottom", "top");
        change(&mut pairs[0]);
        refused(bodies.clone(), pairs)
    };
    let against = |body: Option<&str>, group: &str| {
        Some(SceneSurface {
            body: body.map(str::to_owned),
            group: group.into(),
        })
    };
    let error = with(|pair| pair.against.as_mut().unwrap().body = Some("lover".into()));
    says(
        &error,
        &["contacts[0].against.body", "no body `lover`", "`lower`"],
    );
    let error = with(|pair| pair.against.as_mut().unwrap().group = "tpo".into());
    says(
        &error,
        &["contacts[0].against.group", "no group `tpo`", "`top`"],
    );
    let error = with(|pair| pair.body = Some("uper".into()));
    says(&error, &["contacts[0].body", "`upper`"]);
    let error = with(|pair| pair.against.as_mut().unwrap().body = None);
    says(&error, &["contacts[0].against.body", "lower, upper"]);
    let error = with(|pair| pair.against = None);
    says(&error, &["contacts[0]", "neither"]);
    let error = with(|pair| pair.friction = Some(-0.1));
    says(&error, &["contacts[0].friction", "-0.1"]);
    let error = with(|pair| pair.friction = Some(f64::NAN));
    says(&error, &["contacts[0].friction", "NaN"]);
    let mut pairs = faces("bottom", "top");
    pairs[0].against = against(Some("lower"), "body");
    says(
        &refused(bodies, pairs),
        &["contacts[0].against.group", "of cells"],
    );
}

#[test]
fn a_plane_body_against_a_solid_one_is_refused() {
    let [lower, _] = blocks(CellKind::Quad4, 0.0, 0.0).try_into().unwrap();
    let [_, upper] = blocks(CellKind::Hex8, 0.0, 0.0).try_into().unwrap();
    let error = refused(vec![lower, upper], faces("bottom", "top"));
    says(&error, &["bodies[1].mesh", "3D", "2D"]);

    let bodies = [CellKind::Quad4, CellKind::Hex8].map(|kind| mechanics(kind).0.remove(0));
    let mut pair = mechanics(CellKind::Quad4).1;
    pair.opposite = mechanics(CellKind::Hex8).1.opposite;
    let error = Condensed::new(&bodies, &[pair]).unwrap_err();
    says(&error, &["contacts[0].opposite", "dimension 3"]);
}

/// Bodies and the pair of `upper` with `lower` for the library call: body 0 is the first.
fn mechanics(kind: CellKind) -> (Vec<Body>, ContactPair) {
    let mut bodies = blocks(kind, 0.0, 0.0);
    bodies.reverse();
    let scene: Scene = scene(bodies, faces("bottom", "top"));
    let mut mechanics = scene.mechanics().unwrap();
    (mechanics.bodies, mechanics.contacts.remove(0))
}

#[test]
fn bodies_and_facets_that_do_not_exist_are_refused_in_the_library_call() {
    for kind in CellKind::LINEAR {
        let (bodies, pair) = mechanics(kind);
        assert!(Condensed::new(&bodies, std::slice::from_ref(&pair)).is_ok());
        let with = |change: &dyn Fn(&mut ContactPair)| {
            let mut changed = pair.clone();
            change(&mut changed);
            Condensed::new(&bodies, &[changed]).unwrap_err()
        };
        let error = with(&|pair| pair.body = 2);
        says(
            &error,
            &["contacts[0]", "body 2 does not exist", "less than 2"],
        );
        let other = |body: usize, facets: Vec<Facet>| Opposite::Surface { body, facets };
        let error = with(&|pair| pair.opposite = other(7, Vec::new()));
        says(&error, &["contacts[0].opposite", "body 7 does not exist"]);
        let stray = vec![Facet {
            nodes: vec![0, 999_999],
        }];
        let error = with(&|pair| pair.opposite = other(1, stray.clone()));
        says(&error, &["contacts[0].opposite[0]", "belongs to 0 cells"]);
        let error = with(&|pair| pair.facets.clone_from(&stray));
        says(&error, &["contacts[0].facets[0]", "belongs to 0 cells"]);
        let error = with(&|pair| pair.opposite = other(1, Vec::new()));
        says(&error, &["contacts[0].opposite", "empty"]);
        let error = with(&|pair| pair.facets.clear());
        says(&error, &["contacts[0].facets", "empty"]);

        let error = ContactSurface::new(&bodies, std::slice::from_ref(&pair), &[]).unwrap_err();
        says(&error, &["prescribed", "expected 2 entries"]);
        let short = [vec![], vec![]];
        let error = ContactSurface::new(&bodies, std::slice::from_ref(&pair), &short).unwrap_err();
        says(&error, &["upper: prescribed"]);
    }
}

#[test]
fn facets_that_run_backwards_are_turned_around() {
    for kind in CellKind::LINEAR {
        let (bodies, pair) = mechanics(kind);
        let expected = Condensed::new(&bodies, std::slice::from_ref(&pair)).unwrap();
        let mut turned = pair;
        turned
            .facets
            .iter_mut()
            .for_each(|facet| facet.nodes.reverse());
        if let Opposite::Surface { facets, .. } = &mut turned.opposite {
            facets.iter_mut().for_each(|facet| facet.nodes.reverse());
        }
        let found = Condensed::new(&bodies, &[turned]).unwrap();
        assert_eq!(found.surface().nodes, expected.surface().nodes);
    }
}

#[test]
fn assumed_surfaces_may_hold_more_than_can_touch() {
    // All of the boundary on both sides: the sides and backs look elsewhere, or lie behind.
    for kind in CellKind::LINEAR {
        let mut bodies = blocks(kind, 0.0, 0.0);
        let up = kind.dimension() - 1;
        bodies[1].supports.pop();
        bodies[1] = hold(bodies[1].clone(), "top", up, -0.001);
        let (_, plain) = certified(&scene(bodies.clone(), faces("bottom", "top")));
        for body in &mut bodies {
            let MeshSource::Given(mesh) = &mut body.mesh else {
                unreachable!();
            };
            let all = Group::Facets(mesh.boundary_facets());
            mesh.groups.insert("all".into(), all);
        }
        let (_, grown) = certified(&scene(bodies, faces("all", "all")));
        assert_eq!(plain.size.contacts, grown.size.contacts);
        let off = grown.totals.normal / plain.totals.normal - 1.0;
        assert!(off.abs() < 1e-12, "{kind:?} {off:e}");
    }
}
