#![allow(warnings)]
use dpana::cone::*;
use faer::Mat;
struct Rng(u64);
impl Rng {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
    fn sym(&mut self) -> f64 {
        2.0 * self.next() - 1.0
    }
    fn below(&mut self, n: usize) -> usize {
        (self.next() * n as f64) as usize
    }
}
fn main() {
    let mut rng = Rng(999);
    let n: usize = std::env::args().nth(1).map_or(300, |s| s.parse().unwrap());
    let mut count = std::collections::BTreeMap::new();
    let t0 = std::time::Instant::now();
    for case in 0..n {
        let tang = 1 + rng.below(2);
        let nc = 1 + rng.below(24);
        let nb = 1 + rng.below(3);
        let block = 1 + tang;
        let unk = block * nc;
        let per = if tang == 1 { 3 } else { 6 };
        let entries: Vec<f64> = (0..unk * per).map(|_| rng.sym()).collect();
        let friction: Vec<f64> = (0..nc)
            .map(|_| {
                if rng.next() < 0.5 {
                    0.0
                } else {
                    0.05 + 1.45 * rng.next()
                }
            })
            .collect();
        let numbers: Vec<f64> = (0..unk).map(|_| 10.0 * rng.sym()).collect();
        let modes = Mat::from_fn(unk, per * nb, |row, column| {
            let (c, b) = (row / block, column / per);
            let e = entries[row * per + column % per];
            if c % nb == b {
                e
            } else if c % 2 == 0 && (c + 1) % nb == b {
                -e
            } else {
                0.0
            }
        });
        let rc = RigidContacts::new(&vec![tang; nc], friction.clone(), modes.clone()).unwrap();
        let mut re = numbers.clone();
        for (c, t) in re.chunks_exact_mut(block).enumerate() {
            t[0] = if c % 4 == 3 { 0.0 } else { -t[0].abs() };
            let size = t[1..].iter().map(|x| x * x).sum::<f64>().sqrt();
            let share = if c % 3 == 0 { 1.0 } else { 0.5 };
            let rad = -friction[c] * t[0] * share;
            t[1..].iter_mut().for_each(|x| *x *= rad / size.max(1e-300));
        }
        let fixed: Vec<f64> = (0..modes.ncols())
            .map(|k| (0..unk).map(|i| -modes[(i, k)] * re[i]).sum())
            .collect();
        let growing: Vec<f64> = (0..fixed.len()).map(|k| (1.0 + k as f64).sin()).collect();
        let at = |l: f64| {
            let s: Vec<f64> = fixed.iter().zip(&growing).map(|(f, g)| f + l * g).collect();
            match rc.admissible(&s).unwrap() {
                Equilibrium::Held { .. } => "held",
                Equilibrium::Impossible { .. } => "imp",
                _ => "und",
            }
        };
        if std::env::var("CASE")
            .ok()
            .map_or(false, |c| c != case.to_string())
        {
            continue;
        }
        if let Ok(l) = std::env::var("AT") {
            println!("{}", at(l.parse().unwrap()));
            continue;
        }
        let tl = std::time::Instant::now();
        let l = rc.limit(&fixed, &growing).unwrap();
        let key = match &l {
            Limit::Finite { factor, .. } => {
                let mut k = format!("finite");
                for m in [1e-6, 1e-8, 1e-10] {
                    let mg = m * factor.max(1.0);
                    if *factor > mg && at(factor - mg) != "held" {
                        k += &format!(" below-{m:e}-{}", at(factor - mg));
                    }
                    if at(factor + mg) != "imp" {
                        k += &format!(" above+{m:e}-{}", at(factor + mg));
                    }
                }
                k
            }
            Limit::Unbounded => {
                format!("unb {} {}", at(1.0), at(1e3))
            }
            Limit::Never { .. } => "never".into(),
            _ => "undecided".into(),
        };
        if (key.contains("1e-6") || key.contains("undec") || key.contains("never")) {
            println!(
                "{case} {key} {:?} tang {tang} nc {nc} nb {nb}",
                if let Limit::Finite { factor, .. } = &l {
                    *factor
                } else {
                    -1.0
                }
            );
        }
        *count.entry(key).or_insert(0) += 1;
        let lf = rc.least_friction(&fixed).unwrap();
        let sc = |m: f64| {
            let rc = RigidContacts::new(
                &vec![tang; nc],
                friction.iter().map(|f| f * m).collect(),
                modes.clone(),
            )
            .unwrap();
            match rc.admissible(&fixed).unwrap() {
                Equilibrium::Held { reaction } => format!(
                    "held{}",
                    if reaction
                        .iter()
                        .any(|t| t.abs() > 1e4 * fixed.iter().fold(0.0f64, |a, b| a.max(b.abs())))
                    {
                        "-jam"
                    } else {
                        ""
                    }
                ),
                Equilibrium::Impossible { .. } => "imp".into(),
                _ => "und".into(),
            }
        };
        let key = match &lf {
            LeastFriction::Multiple { multiple, .. } => {
                let k = *multiple;
                if k == 0.0 {
                    "lf zero".into()
                } else {
                    format!(
                        "lf {} {} {}",
                        sc(k * (1.0 + 1e-6)),
                        sc(k * (1.0 - 1e-6)),
                        sc(k * (1.0 - 1e-4))
                    )
                }
            }
            LeastFriction::Never { .. } => "lf never".into(),
            _ => "lf undecided".into(),
        };
        if !key.contains("lf zero") && !key.contains("lf held imp imp") {
            println!("{case} {key} {lf:?}");
        }
        *count.entry(key).or_insert(0) += 1;
    }
    for (k, v) in count {
        println!("{v:6} {k}");
    }
    println!("{:?}", t0.elapsed());
}
