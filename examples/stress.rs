#![allow(
    clippy::all,
    clippy::pedantic,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    missing_docs
)]
use dpana::condensation::{ContactProblem, Operator};
use dpana::dpana::{Settings, Variant, solve};
struct R(u64);
impl R {
    fn u(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
    fn s(&mut self) -> f64 {
        2.0 * self.u() - 1.0
    }
}
fn main() {
    let trials: u64 = std::env::args().nth(1).unwrap().parse().unwrap();
    let (mut bad, mut sweeps, mut newton, mut worst) = (0, 0, 0, 0.0f64);
    let mut hist = std::collections::BTreeMap::new();
    for seed in 1..=trials {
        let mut r = R(seed.wrapping_mul(0x9E3779B97F4A7C15) | 1);
        for _ in 0..5 {
            r.u();
        }
        let nc = 1 + (r.u() * 40.0) as usize;
        let t = 1 + (r.u() * 2.0) as usize;
        let n = nc * (1 + t);
        let rank = if r.u() < 0.5 { n } else { 2 * n };
        let a = faer::Mat::from_fn(rank, n, |_, _| r.s());
        let eps = 10f64.powf(-4.0 * r.u());
        let mut g = a.transpose() * &a * faer::Scale(1.0 / n as f64);
        for i in 0..n {
            g[(i, i)] += eps;
        }
        let g2 = faer::Mat::from_fn(n, n, |i, j| 0.5 * (g[(i, j)] + g[(j, i)]));
        let mu: Vec<f64> = (0..nc).map(|_| 2.0 * r.u()).collect();
        let gap: Vec<f64> = (0..nc).map(|_| r.s() * 0.3).collect();
        let uh: Vec<f64> = (0..n).map(|_| r.s()).collect();
        let p = ContactProblem::new(
            &vec![t; nc],
            mu,
            gap,
            uh,
            Operator::from_compliance(g2).unwrap(),
        )
        .unwrap();
        let o = solve(
            &p,
            &Settings {
                tolerance: 1e-12,
                max_sweeps: 100,
                variant: Variant::Default,
            },
        )
        .unwrap();
        let res = o.verdict.certificate.natural_map;
        sweeps += o.work.sweeps;
        newton += o.work.newton_steps;
        *hist.entry(o.work.sweeps).or_insert(0) += 1;
        worst = worst.max(res);
        if res > 1e-10 {
            bad += 1;
            if bad < 12 {
                println!(
                    "seed {seed} nc {nc} t {t} eps {eps:.1e} rank {} : {:?} {res:.2e} sweeps {} newton {}",
                    rank / n,
                    o.status,
                    o.work.sweeps,
                    o.work.newton_steps
                );
            }
        }
    }
    println!("bad {bad}/{trials} sweeps {sweeps} newton {newton} worst {worst:.2e} {hist:?}");
}
