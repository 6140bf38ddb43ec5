//! One factorisation, in which every rank takes part; all of them end it in the same way.

use super::World;
use super::entries::Entries;
use crate::stage;

/// Room beyond its estimate that MUMPS gets, in percent, each after the one before did not suffice.
const ROOM: [i32; 3] = [30, 100, 400];

/// Part of its diagonal that is added to a matrix with a pivot of zero, so that it shows which motion has none.
const SHIFT: f64 = 1e-10;

/// Bytes of a failure in words that get from rank to rank.
const TEXT: usize = 1024;

/// Memory that a rank needs for the factors of the bodies, in bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RankMemory {
    /// As the analysis estimates it before anything is factorised.
    pub estimated: f64,
    /// As it was in the end.
    pub used: f64,
}

/// A factorised matrix.
#[derive(Debug)]
pub(super) struct Factorised {
    /// The instance.
    pub(super) number: usize,
    /// On rank 0, per rank.
    pub(super) memory: Vec<RankMemory>,
    /// A pivot was zero: what is factorised is the shifted matrix.
    pub(super) singular: bool,
}

/// Factorises the sum of the entries of all ranks, or says on all of them why not. `complement` is the Schur
/// complement of the last unknowns, on rank 0, its lower triangle by rows.
pub(super) fn factorise(
    world: &mut World,
    entries: Result<Entries, String>,
    (size, schur): (usize, usize),
    complement: &mut [f64],
) -> Result<Factorised, String> {
    let entries = agreed(world, entries)?;
    let begun = world.begin().ok_or_else(|| "no memory".to_owned());
    let number = agreed(world, begun)?;
    let done = analysed(world, number, (size, schur), entries).and_then(|estimated| {
        let singular = eliminated(world, number, complement)?;
        let bytes = 1e6 * f64::from(world.said_here(number, 22));
        let used = world.gather(bytes);
        let of_rank = |(estimated, used)| RankMemory { estimated, used };
        Ok(Factorised {
            number,
            memory: estimated.into_iter().zip(used).map(of_rank).collect(),
            singular,
        })
    });
    match done {
        Ok(_) => world.forget(number),
        Err(_) => world.free(number),
    }
    done
}

/// Estimated memory per rank on rank 0, in bytes.
fn analysed(
    world: &mut World,
    number: usize,
    sizes: (usize, usize),
    entries: Entries,
) -> Result<Vec<f64>, String> {
    let code = world.analyse(number, sizes, entries);
    if code != 0 {
        return Err(words(world, number, code));
    }
    let bytes = 1e6 * f64::from(world.said_here(number, 15));
    let share = world.share_of_memory(bytes);
    let room = match share <= 1.0 {
        true => Ok(()),
        false => Err(format!(
            "the ranks of a machine need {share:.1} times the memory that it has; expected more machines, or a \
             coarser mesh"
        )),
    };
    agreed(world, room)?;
    let estimated = world.gather(bytes);
    stage::divided(estimated.iter().fold(0.0, |most, &bytes| bytes.max(most)));
    Ok(estimated)
}

/// Whether a pivot was zero.
fn eliminated(world: &mut World, number: usize, complement: &mut [f64]) -> Result<bool, String> {
    let (mut room, mut singular) = (ROOM.iter(), false);
    let mut percent = room.next();
    while let Some(&enough) = percent {
        match world.factorise(number, enough, complement) {
            -10 if !singular => {
                singular = true;
                world.entries(number).shift(SHIFT);
            }
            -8 | -9 => percent = room.next(),
            code @ ..0 => return Err(words(world, number, code)),
            _ => return Ok(singular),
        }
    }
    let code = world.said(number, 1);
    Err(words(world, number, code))
}

/// What all ranks have, or in words what the first that has nothing says.
fn agreed<T>(world: &mut World, had: Result<T, String>) -> Result<T, String> {
    let (rank, count) = (world.rank() as i32, world.count() as i32);
    let first = world.least(if had.is_ok() { count } else { rank });
    if first == count {
        return had;
    }
    let mut text = [0; TEXT];
    if let Err(reason) = &had {
        let length = reason.len().min(TEXT);
        text[..length].copy_from_slice(&reason.as_bytes()[..length]);
    }
    world.text(first, &mut text);
    let length = text.iter().position(|&byte| byte == 0).unwrap_or(TEXT);
    let reason = String::from_utf8_lossy(&text[..length]);
    Err(match first {
        0 => reason.into_owned(),
        _ => format!("rank {first}: {reason}"),
    })
}

/// What INFOG(1) means.
pub(super) fn words(world: &mut World, number: usize, code: i32) -> String {
    let detail = world.said(number, 2);
    let meaning = match code {
        -5 | -7 | -13 => "there is not enough memory",
        -8 | -9 => "its workspace is too small",
        -10 => "the matrix is singular",
        -51 | -52 => "the ordering does not fit its integers",
        _ => "see its manual",
    };
    format!("MUMPS ends with INFOG(1) = {code}, INFOG(2) = {detail}: {meaning}")
}
