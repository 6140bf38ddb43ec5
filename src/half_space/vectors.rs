//! Sums whose bits do not depend on the number of threads: fixed chunks, added in order.

use rayon::prelude::*;

/// Entries of a chunk; below it nothing is worth a thread.
const CHUNK: usize = 1 << 14;

/// Σ over the indices below `length` of `term`, chunk by chunk.
pub(super) fn sum(length: usize, term: impl Fn(usize) -> f64 + Sync) -> f64 {
    let chunk = |number: usize| -> f64 {
        let start = number * CHUNK;
        (start..(start + CHUNK).min(length)).map(&term).sum()
    };
    if length <= CHUNK {
        return chunk(0);
    }
    let parts: Vec<f64> = (0..length.div_ceil(CHUNK))
        .into_par_iter()
        .map(chunk)
        .collect();
    parts.iter().sum()
}

pub(super) fn dot(one: &[f64], other: &[f64]) -> f64 {
    sum(one.len(), |at| one[at] * other[at])
}

pub(super) fn norm(vector: &[f64]) -> f64 {
    dot(vector, vector).sqrt()
}

pub(super) fn total(vector: &[f64]) -> f64 {
    sum(vector.len(), |at| vector[at])
}

/// The largest of numbers that are not negative.
pub(super) fn largest<'a>(values: impl IntoIterator<Item = &'a f64>) -> f64 {
    values.into_iter().copied().fold(0.0, f64::max)
}

pub(super) fn scaled(vector: &[f64], factor: f64) -> Vec<f64> {
    vector.iter().map(|entry| factor * entry).collect()
}

/// `to += factor · from`.
pub(super) fn add(to: &mut [f64], factor: f64, from: &[f64]) {
    let pairs = to.par_chunks_mut(CHUNK).zip(from.par_chunks(CHUNK));
    pairs.for_each(|(to, from)| {
        for (to, from) in to.iter_mut().zip(from) {
            *to += factor * from;
        }
    });
}

/// A vector in the tangents: along x, along y.
pub(super) type Pair = [Vec<f64>; 2];

pub(super) fn dot_pair(one: &Pair, other: &Pair) -> f64 {
    sum(one[0].len(), |at| {
        one[0][at] * other[0][at] + one[1][at] * other[1][at]
    })
}

pub(super) fn norm_pair(pair: &Pair) -> f64 {
    dot_pair(pair, pair).sqrt()
}

pub(super) fn add_pair(to: &mut Pair, factor: f64, from: &Pair) {
    for (to, from) in to.iter_mut().zip(from) {
        add(to, factor, from);
    }
}

pub(super) fn zero_pair(length: usize) -> Pair {
    [vec![0.0; length], vec![0.0; length]]
}
