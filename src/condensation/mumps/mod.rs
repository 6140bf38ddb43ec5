//! Factors divided among the processes of an MPI run, by MUMPS.
//!
//! P. R. Amestoy, I. S. Duff, J.-Y. L'Excellent & J. Koster, A fully asynchronous multifrontal solver using
//! distributed dynamic scheduling, SIAM J. Matrix Anal. Appl. 23 (2001) 15–41.
//!
//! | step | file |
//! |---|---|
//! | MPI and MUMPS, as far as they are called; a build without them | `face`, `absent` |
//! | what a rank assembles | `entries` |
//! | one factorisation on all ranks, its memory | `factorisation` |
//! | the factor as rank 0 sees it: G, v̂, displacements, the probe | `divided` |
//! | who asks and who serves | `ranks` |
//!
//! Every rank reads the scene and assembles a run of its cells. Rank 0 alone orders, holds the whole of K for
//! the judge, forms G and solves the contacts, while the others sleep. On one rank the same bits come in every
//! run, on several they do not: MUMPS adds in the order in which messages arrive.

#[cfg(not(mumps))]
mod absent;
mod divided;
mod entries;
#[cfg(mumps)]
mod face;
mod factorisation;
mod ranks;

#[cfg(not(mumps))]
use absent::World;
#[cfg(mumps)]
use face::World;

use crate::body::Body;

pub(super) use divided::{Divided, Refusal, Whole};
pub use factorisation::RankMemory;
pub use ranks::Ranks;

/// Tells whether ranks have the same body: FNV-1a of Fowler, Noll and Vo over its nodes and cells.
fn mark(body: &Body) -> [i32; 2] {
    let nodes = body.mesh.nodes.iter().flatten().map(|x| x.to_bits());
    let cells = body.mesh.cells().flat_map(|cell| cell.nodes);
    let cells = cells.chain(&body.material_of_cell).map(|&n| n as u64);
    let hash = nodes
        .chain(cells)
        .fold(0xcbf2_9ce4_8422_2325, |hash, word| {
            (hash ^ word).wrapping_mul(0x0100_0000_01b3)
        });
    [(hash >> 32) as i32, hash as i32]
}
