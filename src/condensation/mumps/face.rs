//! MPI and MUMPS behind safe calls; with `ordering` the only file that calls C.
//!
//! `face.c` says what each function does. What holds for all of them: one thread at a time is inside, as every
//! call takes the [`World`] for itself and there is one; arrays that MUMPS keeps are owned by the world until it
//! is told to forget them.
#![allow(unsafe_code)]

use std::ffi::{c_char, c_double, c_int, c_longlong};
use std::sync::atomic::{AtomicBool, Ordering};

use super::entries::Entries;

unsafe extern "C" {
    fn dpana_ranks_join(rank: *mut c_int, count: *mut c_int) -> c_int;
    fn dpana_ranks_leave();
    fn dpana_ranks_abort();
    fn dpana_ranks_tell(numbers: *mut c_int, count: c_int);
    fn dpana_ranks_least(number: c_int) -> c_int;
    fn dpana_ranks_text(from: c_int, text: *mut c_char, length: c_int);
    fn dpana_ranks_gather(number: c_double, all: *mut c_double);
    fn dpana_ranks_share_of_memory(bytes: c_double) -> c_double;
    fn dpana_mumps_new() -> c_int;
    fn dpana_mumps_analyse(
        number: c_int,
        size: c_int,
        schur: c_int,
        entries: c_longlong,
        rows: *mut c_int,
        columns: *mut c_int,
        values: *mut c_double,
    ) -> c_int;
    fn dpana_mumps_factorise(
        number: c_int,
        room: c_int,
        values: *mut c_double,
        schur: *mut c_double,
    ) -> c_int;
    fn dpana_mumps_solve(
        number: c_int,
        way: c_int,
        force: *mut c_double,
        reduced: *mut c_double,
    ) -> c_int;
    fn dpana_mumps_forget(number: c_int);
    fn dpana_mumps_said(number: c_int, global: c_int, i: c_int) -> c_int;
    fn dpana_mumps_free(number: c_int);
}

/// MPI has been begun once, which it can be only once.
static BEGUN: AtomicBool = AtomicBool::new(false);

/// The processes of the run, seen from one of them.
#[derive(Debug)]
pub(super) struct World {
    rank: i32,
    count: i32,
    instances: Vec<Instance>,
}

/// What MUMPS has been told of a matrix.
#[derive(Debug, Default)]
struct Instance {
    /// Made, and not yet freed.
    exists: bool,
    size: usize,
    schur: usize,
    entries: Entries,
}

impl World {
    pub(super) fn join() -> Result<Self, String> {
        if BEGUN.swap(true, Ordering::SeqCst) {
            return Err("MPI again, which begins once in a process".to_owned());
        }
        let (mut rank, mut count) = (0, 1);
        // SAFETY: both pointers are to integers of ours; the flag lets no second call in.
        match unsafe { dpana_ranks_join(&raw mut rank, &raw mut count) } {
            0 => Ok(Self {
                rank,
                count,
                instances: Vec::new(),
            }),
            1 => Err("MPI that somebody else began".to_owned()),
            3 => Err("an MPI that a single thread may call".to_owned()),
            _ => Err("an MPI that does not begin".to_owned()),
        }
    }

    pub(super) fn rank(&self) -> usize {
        self.rank as usize
    }

    pub(super) fn count(&self) -> usize {
        self.count as usize
    }

    pub(super) fn leave(self) {
        // SAFETY: MPI has begun, and nobody has a world after this.
        unsafe { dpana_ranks_leave() }
    }

    pub(super) fn abort(&mut self) {
        // SAFETY: MPI has begun.
        unsafe { dpana_ranks_abort() }
    }

    /// Numbers of rank 0, as many as every rank expects; fewer than 2³¹.
    pub(super) fn tell(&mut self, numbers: &mut [i32]) {
        let count = numbers.len() as c_int;
        // SAFETY: the slice has `count` numbers, and stays until the call returns.
        unsafe { dpana_ranks_tell(numbers.as_mut_ptr(), count) }
    }

    pub(super) fn least(&mut self, number: i32) -> i32 {
        // SAFETY: MPI has begun.
        unsafe { dpana_ranks_least(number) }
    }

    /// Text of one rank, as long as every rank expects.
    pub(super) fn text(&mut self, from: i32, text: &mut [u8]) {
        let length = text.len() as c_int;
        // SAFETY: the slice has `length` bytes, and stays until the call returns.
        unsafe { dpana_ranks_text(from, text.as_mut_ptr().cast(), length) }
    }

    /// A number of every rank, zeros except on rank 0.
    pub(super) fn gather(&mut self, number: f64) -> Vec<f64> {
        let mut all = vec![0.0; self.count()];
        // SAFETY: `all` has an entry per rank.
        unsafe { dpana_ranks_gather(number, all.as_mut_ptr()) }
        all
    }

    pub(super) fn share_of_memory(&mut self, bytes: f64) -> f64 {
        // SAFETY: MPI has begun.
        unsafe { dpana_ranks_share_of_memory(bytes) }
    }

    /// A new instance; none where there is no memory.
    pub(super) fn begin(&mut self) -> Option<usize> {
        // SAFETY: MPI has begun.
        let number = usize::try_from(unsafe { dpana_mumps_new() }).ok()?;
        if number >= self.instances.len() {
            self.instances.resize_with(number + 1, Instance::default);
        }
        self.instances[number].exists = true;
        Some(number)
    }

    fn instance(&mut self, number: usize) -> (c_int, &mut Instance) {
        let instance = &mut self.instances[number];
        assert!(instance.exists, "no instance {number}");
        (number as c_int, instance)
    }

    /// `size` and `schur` are those of every rank and below 2³¹.
    pub(super) fn analyse(
        &mut self,
        number: usize,
        (size, schur): (usize, usize),
        entries: Entries,
    ) -> i32 {
        let (number, instance) = self.instance(number);
        (instance.size, instance.schur) = (size, schur);
        instance.entries = entries;
        let (rows, columns, values) = instance.entries.parts();
        assert!(rows.len() == values.len() && columns.len() == values.len());
        // SAFETY: the instance exists; the three arrays have as many entries as is said, and belong to the world
        // until `forget` or `free`, before which they are neither moved nor changed.
        unsafe {
            dpana_mumps_analyse(
                number,
                size as c_int,
                schur as c_int,
                values.len() as c_longlong,
                rows.as_mut_ptr(),
                columns.as_mut_ptr(),
                values.as_mut_ptr(),
            )
        }
    }

    /// After `analyse`; `complement` has the square of `schur` entries on rank 0.
    pub(super) fn factorise(&mut self, number: usize, room: i32, complement: &mut [f64]) -> i32 {
        let leads = self.rank == 0;
        let (number, instance) = self.instance(number);
        assert!(!leads || complement.len() == instance.schur * instance.schur);
        let (_, _, values) = instance.entries.parts();
        // SAFETY: the instance is analysed, with as many values; `complement` is as large as MUMPS fills it. The
        // values belong to the world, as in `analyse`; the complement is not kept.
        unsafe { dpana_mumps_factorise(number, room, values.as_mut_ptr(), complement.as_mut_ptr()) }
    }

    /// Changes the entries before the next factorisation.
    pub(super) fn entries(&mut self, number: usize) -> &mut Entries {
        &mut self.instance(number).1.entries
    }

    /// After `factorise`; on rank 0 `force` has the size of the matrix and `reduced` of its Schur complement.
    pub(super) fn solve(
        &mut self,
        number: usize,
        way: i32,
        force: &mut [f64],
        reduced: &mut [f64],
    ) -> i32 {
        let leads = self.rank == 0;
        let (number, instance) = self.instance(number);
        let fits = force.len() == instance.size && reduced.len() == instance.schur;
        assert!(!leads || fits);
        // SAFETY: the instance is factorised; both arrays are as large as MUMPS reads and fills them, and are not
        // kept.
        unsafe { dpana_mumps_solve(number, way, force.as_mut_ptr(), reduced.as_mut_ptr()) }
    }

    /// Gives the entries back.
    pub(super) fn forget(&mut self, number: usize) {
        let (number, instance) = self.instance(number);
        // SAFETY: the instance exists; it reads its entries no more.
        unsafe { dpana_mumps_forget(number) }
        instance.entries = Entries::default();
    }

    /// INFOG(i).
    pub(super) fn said(&mut self, number: usize, i: i32) -> i32 {
        let (number, _) = self.instance(number);
        // SAFETY: the instance exists, and i is from 1 to 80.
        unsafe { dpana_mumps_said(number, 1, i) }
    }

    /// INFO(i) of this rank.
    pub(super) fn said_here(&mut self, number: usize, i: i32) -> i32 {
        let (number, _) = self.instance(number);
        // SAFETY: the instance exists, and i is from 1 to 80.
        unsafe { dpana_mumps_said(number, 0, i) }
    }

    pub(super) fn free(&mut self, number: usize) {
        let (number, instance) = self.instance(number);
        // SAFETY: the instance exists, and counts as freed after this.
        unsafe { dpana_mumps_free(number) }
        *instance = Instance::default();
    }
}
