//! Numbers of any kind to the bare problem: what is refused, what is solved, and whether it is.
#![no_main]

use arbitrary::{Arbitrary, Result, Unstructured};
use dpana::problem::{ContactProblem, Floating, Operator};
use dpana::alternation::{Settings, solve};
use dpana::study::Variant;
use dpana_fuzz::witness;
use faer::Mat;
use libfuzzer_sys::fuzz_target;

/// Most contacts.
const CONTACTS: usize = 12;

/// Enough for every number of the largest problem.
const MOST_BYTES: usize = 8192;

/// Numbers that programs trip over.
const SPECIAL: [f64; 12] = [
    0.0,
    -0.0,
    1.0,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    5e-324,
    1e-310,
    1e-154,
    1e154,
    1e300,
    f64::MAX,
];

/// A problem in plain numbers.
#[derive(Debug)]
struct Numbers {
    tangents: Vec<usize>,
    friction: Vec<f64>,
    gap: Vec<f64>,
    free: Vec<f64>,
    compliance: Mat<f64>,
    modes: Option<(Mat<f64>, Vec<f64>)>,
    settings: Settings,
    /// None is the default loop.
    variant: Option<Variant>,
}

/// Mostly tame, sometimes anything.
fn number(from: &mut Unstructured<'_>, strange: bool) -> Result<f64> {
    let tame = |from: &mut Unstructured<'_>| Ok(f64::from(i8::arbitrary(from)?) / 64.0);
    if !strange {
        return tame(from);
    }
    match from.int_in_range(0..=15)? {
        0 => Ok(SPECIAL[from.choose_index(SPECIAL.len())?]),
        1 => f64::arbitrary(from),
        2 => Ok(tame(from)? * 10_f64.powi(from.int_in_range(-30..=30)?)),
        3 => Ok(tame(from)? * (1.0 + f64::EPSILON)),
        _ => tame(from),
    }
}

fn numbers(from: &mut Unstructured<'_>, count: usize, strange: bool) -> Result<Vec<f64>> {
    (0..count).map(|_| number(from, strange)).collect()
}

impl<'a> Arbitrary<'a> for Numbers {
    fn arbitrary(from: &mut Unstructured<'a>) -> Result<Self> {
        let strange: [bool; 4] = Arbitrary::arbitrary(from)?;
        // Small problems are as strange as large ones, and many more of them are tried.
        let most = if from.ratio(1, 8)? { CONTACTS } else { 4 };
        let contacts = from.int_in_range(0..=most)?;
        let tangents: Vec<usize> = match from.int_in_range(0..=4_u8)? {
            0 => vec![0; contacts],
            1 => vec![1; contacts],
            2 => vec![2; contacts],
            _ => (0..contacts)
                .map(|_| from.int_in_range(0..=3_usize))
                .collect::<Result<_>>()?,
        };
        let size = tangents.iter().sum::<usize>() + contacts;
        let friction = numbers(from, contacts, strange[0])?;
        let friction = friction
            .iter()
            .map(|mu| if strange[0] { *mu } else { mu.abs() });
        let friction = friction.collect();
        let (gap, free) = (
            numbers(from, contacts, strange[1])?,
            numbers(from, size, strange[1])?,
        );
        let compliance = compliance(from, size, strange[2])?;
        let modes = match from.int_in_range(0..=7_u8)? {
            count @ 0..=2 => {
                let count = usize::from(count) + 1;
                let entries = numbers(from, size * count, strange[3])?;
                let modes = Mat::from_fn(size, count, |i, j| entries[i + j * size]);
                Some((modes, numbers(from, count, strange[3])?))
            }
            _ => None,
        };
        let settings = match from.int_in_range(0..=9_u8)? {
            0 => Settings::default().with_tolerance(number(from, true)?).with_max_sweeps(from.int_in_range(0..=30)?),
            1 => Settings::default().with_tolerance(10_f64.powi(from.int_in_range(-17..=0)?)),
            2 => Settings::default(),
            _ => Settings::default().with_max_sweeps(12),
        };
        let variant = match from.int_in_range(0..=19_u8)? {
            0 => Some(Variant::PLAIN),
            1 => Some(Variant::Nsgs),
            _ => None,
        };
        Ok(Self {
            tangents,
            friction,
            gap,
            free,
            compliance,
            modes,
            settings,
            variant,
        })
    }
}

/// Symmetric and definite, or nearly so, or low in rank, or badly scaled, or anything.
fn compliance(from: &mut Unstructured<'_>, size: usize, strange: bool) -> Result<Mat<f64>> {
    let kind = from.int_in_range(0..=6_u8)?;
    let rank = match kind {
        0 | 1 => from.int_in_range(0..=size)?,
        _ => size,
    };
    let entries = numbers(from, rank * size, strange)?;
    let factor = Mat::from_fn(rank, size, |i, j| entries[i * size + j]);
    if kind == 6 && rank == size {
        return Ok(factor);
    }
    let shift = if kind == 1 {
        0.0
    } else {
        number(from, strange)?.abs()
    };
    let mut product = factor.transpose() * &factor;
    for i in 0..size {
        product[(i, i)] += shift;
        for j in 0..i {
            product[(i, j)] = product[(j, i)];
        }
    }
    if kind == 4 {
        let scale: Vec<i32> = (0..size)
            .map(|_| from.int_in_range(-12..=12))
            .collect::<Result<_>>()?;
        for (i, a) in scale.iter().enumerate() {
            for (j, b) in scale.iter().enumerate() {
                product[(i, j)] *= 10_f64.powi(a + b);
            }
        }
    }
    if kind == 5 && size > 0 {
        let (i, j) = (from.choose_index(size)?, from.choose_index(size)?);
        let disturbance = number(from, true)? * 10_f64.powi(from.int_in_range(-14..=0)?);
        product[(i, j)] += disturbance;
        if bool::arbitrary(from)? && i != j {
            product[(j, i)] += disturbance;
        }
    }
    Ok(product)
}

/// The bytes, and behind them as many as a problem may need, drawn from the first four: short
/// inputs make problems as large as long ones do.
fn lengthened(bytes: &[u8]) -> Vec<u8> {
    let mut state = bytes
        .iter()
        .take(4)
        .fold(0x9E37_79B9_7F4A_7C15_u64, |seed, &b| {
            (seed ^ u64::from(b)).wrapping_mul(0x0100_0000_01B3)
        });
    let drawn = std::iter::repeat_with(move || {
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        (state.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 56) as u8
    });
    bytes
        .iter()
        .copied()
        .chain(drawn)
        .take(MOST_BYTES)
        .collect()
}

fuzz_target!(|bytes: &[u8]| {
    let bytes = lengthened(bytes);
    let Ok(numbers) = Numbers::arbitrary(&mut Unstructured::new(&bytes)) else {
        return;
    };
    let Numbers {
        tangents,
        friction,
        gap,
        free,
        compliance,
        modes,
        settings,
        variant,
    } = numbers;
    let Ok(operator) = Operator::from_compliance(compliance) else {
        return;
    };
    let Ok(mut problem) = ContactProblem::new(&tangents, friction, gap, free, operator) else {
        return;
    };
    if let Some((modes, load)) = modes {
        match Floating::new(modes, load).and_then(|floating| problem.clone().float(floating)) {
            Ok(floats) => problem = floats,
            Err(_) => return,
        }
    }
    let outcome = match variant {
        None => solve(&problem, &settings),
        Some(variant) => variant.solve(&problem, &settings),
    };
    if let Ok(outcome) = outcome {
        witness(&problem, &outcome, settings.tolerance);
    }
});
