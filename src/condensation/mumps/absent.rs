//! A build without MUMPS: there is no [`World`], so nothing that needs one is ever reached.

use super::entries::Entries;

/// Nothing.
#[derive(Debug)]
pub(super) enum World {}

impl World {
    pub(super) fn join() -> Result<Self, String> {
        Err(match cfg!(feature = "mumps") {
            true => "`mumps` in a program built where MUMPS was not installed",
            false => "`mumps` in a program built without the feature `mumps`",
        }
        .to_owned())
    }

    pub(super) fn rank(&self) -> usize {
        match *self {}
    }

    pub(super) fn count(&self) -> usize {
        match *self {}
    }

    pub(super) fn leave(self) {
        match self {}
    }

    pub(super) fn abort(&mut self) {
        match *self {}
    }

    pub(super) fn tell(&mut self, _: &mut [i32]) {
        match *self {}
    }

    pub(super) fn least(&mut self, _: i32) -> i32 {
        match *self {}
    }

    pub(super) fn text(&mut self, _: i32, _: &mut [u8]) {
        match *self {}
    }

    pub(super) fn gather(&mut self, _: f64) -> Vec<f64> {
        match *self {}
    }

    pub(super) fn share_of_memory(&mut self, _: f64) -> f64 {
        match *self {}
    }

    pub(super) fn begin(&mut self) -> Option<usize> {
        match *self {}
    }

    pub(super) fn analyse(&mut self, _: usize, _: (usize, usize), _: Entries) -> i32 {
        match *self {}
    }

    pub(super) fn factorise(&mut self, _: usize, _: i32, _: &mut [f64]) -> i32 {
        match *self {}
    }

    pub(super) fn entries(&mut self, _: usize) -> &mut Entries {
        match *self {}
    }

    pub(super) fn solve(&mut self, _: usize, _: i32, _: &mut [f64], _: &mut [f64]) -> i32 {
        match *self {}
    }

    pub(super) fn forget(&mut self, _: usize) {
        match *self {}
    }

    pub(super) fn said(&mut self, _: usize, _: i32) -> i32 {
        match *self {}
    }

    pub(super) fn said_here(&mut self, _: usize, _: i32) -> i32 {
        match *self {}
    }

    pub(super) fn free(&mut self, _: usize) {
        match *self {}
    }
}
