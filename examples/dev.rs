#![allow(
    clippy::all,
    clippy::pedantic,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    missing_docs
)]
use dpana::condensation::*;
use dpana::dpana::{Settings, Variant, solve};
use dpana::scene::Scene;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let n: usize = a[2].parse().unwrap();
    let text = if a[1] == "cube" {
        format!(
            r#"{{"bodies":[{{"name":"c","mesh":{{"box":{{"x":[0,1],"y":[0,1],"z":[0,1],"cells":[{n},{n},{n}]}}}},"materials":[{{"young":1000,"poisson":0.3}}],"supports":[{{"group":"top","displacement":[0.0045,0,-0.01]}}]}}],"contacts":[{{"group":"bottom","obstacle":{{"plane":{{"point":[0,0,0],"normal":[0,0,1]}}}},"friction":0.3}}]}}"#
        )
    } else {
        format!(
            r#"{{"bodies":[{{"name":"c","mesh":{{"rectangle":{{"x":[0,0.04],"y":[0,0.04],"cells":[{n},{n}]}}}},"model":"plane_strain","materials":[{{"young":1.3e11,"poisson":0.2}}],"supports":[{{"group":"right","displacement":[0,null]}},{{"at":[0.04,0],"displacement":[null,0]}}],"loads":[{{"group":"top","pressure":5e7}},{{"group":"left","pressure":15e7}}]}}],"contacts":[{{"group":"bottom","obstacle":{{"plane":{{"point":[0,0],"normal":[0,1]}}}},"friction":1.0}}]}}"#
        )
    };
    let s = Scene::from_json(&text, "x").unwrap();
    let m = s.mechanics().unwrap();
    let c = Condensed::new(&m.bodies, &m.contacts).unwrap();
    let w = c.work();
    println!("{:?}", w);
    for which in &a[3..] {
        let (variant, max, tol) = match which.as_str() {
            "plain" => (Variant::Plain, 40, 1e-12),
            "nsgs" => (Variant::Nsgs, 20000, 1e-12),
            "nsgs8" => (Variant::Nsgs, 20000, 1e-8),
            _ => (Variant::Default, 60, 1e-12),
        };
        let t = std::time::Instant::now();
        let o = solve(
            c.problem(),
            &Settings {
                tolerance: tol,
                max_sweeps: max,
                variant,
            },
        )
        .unwrap();
        let dt = t.elapsed().as_secs_f64();
        println!(
            "{which}: {:?} residual {:.2e} {:.4} s",
            o.status, o.verdict.certificate.natural_map, dt
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
        let t = std::time::Instant::now();
        let u = c.recover(&o.reaction).unwrap();
        let rec = t.elapsed().as_secs_f64();
        println!(
            "  recover {rec:.3} {} ratio {:.3}",
            u[0].len(),
            (w.condensation_seconds + dt + rec) / w.factorisation_seconds
        );
    }
}
