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
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let b = std::fs::read(&a[1]).unwrap();
    let dim = i64::from_le_bytes(b[0..8].try_into().unwrap()) as usize;
    let nc = i64::from_le_bytes(b[8..16].try_into().unwrap()) as usize;
    let v: Vec<f64> = b[16..]
        .chunks_exact(8)
        .map(|c| f64::from_le_bytes(c.try_into().unwrap()))
        .collect();
    let n = nc * dim;
    let (mu, r) = v.split_at(nc);
    let (gap, r) = r.split_at(nc);
    let (uh, g) = r.split_at(n);
    let op = Operator::from_compliance(faer::Mat::from_fn(n, n, |i, j| g[i * n + j])).unwrap();
    let p = ContactProblem::new(
        &vec![dim - 1; nc],
        mu.to_vec(),
        gap.to_vec(),
        uh.to_vec(),
        op,
    )
    .unwrap();
    for which in &a[2..] {
        let (variant, max, tol) = match which.as_str() {
            "plain" => (Variant::Plain, 40, 1e-12),
            "nsgs" => (Variant::Nsgs, 20000, 1e-12),
            "nsgs8" => (Variant::Nsgs, 20000, 1e-8),
            _ => (Variant::Default, 60, 1e-12),
        };
        let t = std::time::Instant::now();
        let o = solve(
            &p,
            &Settings {
                tolerance: tol,
                max_sweeps: max,
                variant,
            },
        )
        .unwrap();
        println!(
            "{which}: {:?} residual {:.2e} {:.4} s",
            o.status,
            o.verdict.certificate.natural_map,
            t.elapsed().as_secs_f64()
        );
        println!("  {:?}", o.work);
        if o.history.len() < 70 {
            for h in &o.history {
                println!(
                    "  {:.2e} it {} {} newton {} {:?} {:.4}",
                    h.residual,
                    h.normal_iterations,
                    h.friction_iterations,
                    h.newton_steps,
                    h.open_stick_slip,
                    h.seconds
                );
            }
        }
    }
}
