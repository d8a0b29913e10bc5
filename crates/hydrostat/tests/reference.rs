//! Arms solved by an independent program (`validation/reference`), compared number by number.

use hydrostat::{Options, Solver};
use hydrostat_files::ArmFile;
use serde_json::Value;

fn numbers(v: &Value) -> Vec<f64> {
    v.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

#[test]
fn configurations_agree_with_an_independent_solver() {
    let text = include_str!("../../../validation/reference/cases.json");
    let cases: Vec<Value> = serde_json::from_str(text).unwrap();
    let mut failed = Vec::new();
    for case in &cases {
        let name = case["name"].as_str().unwrap();
        if std::env::var("ONLY").is_ok_and(|o| match o.strip_suffix('!') {
            Some(exact) => name != exact,
            None => !name.contains(&o),
        }) {
            continue;
        }
        let arm = ArmFile::parse(case["toml"].as_str().unwrap(), name).unwrap().arm().unwrap();
        let mut solver = Solver::new(&arm, Options { tol: 1e-8 }).unwrap();
        let solved = match solver.solve() {
            Ok(solved) => solved,
            Err(e) => {
                eprintln!("{name:40} {e}");
                failed.push(name);
                continue;
            }
        };
        let (tip, want) = (solved.tip(), &case["tip"]);
        let far = (tip.x - want["x"].as_f64().unwrap()).hypot(tip.y - want["y"].as_f64().unwrap()) / arm.length;
        let st = &case["stations"];
        let mut worst = 0.0_f64;
        let mut place = 0.0;
        for (k, s) in numbers(&st["s"]).iter().enumerate() {
            let own = solved.at(*s);
            let pick = |key: &str| numbers(&st[key])[k];
            let largest = |key: &str| numbers(&st[key]).iter().fold(1e-6_f64, |m, v| m.max(v.abs()));
            for (value, key) in [
                (own.x / arm.length, "x"),
                (own.y / arm.length, "y"),
                (own.theta, "theta"),
                (own.nu, "nu"),
                (own.eta, "eta"),
                (own.mu, "mu"),
                (own.beta, "beta"),
                (own.alpha, "alpha"),
                (own.n_a, "n_a"),
                (own.n_b, "n_b"),
                (own.m, "m"),
            ] {
                let scale = if key == "x" || key == "y" { arm.length } else { 1.0 };
                let size = if key == "x" || key == "y" {
                    1.0
                } else {
                    largest(key).max(if key.starts_with('n') || key == "m" { 1e-6 } else { 1.0 })
                };
                let off = (value - pick(key) / scale).abs() / size;
                // A cable that ends here makes both sides valid.
                if off > worst {
                    worst = off;
                    place = *s;
                }
            }
        }
        let ratio = far * arm.length / solved.error_estimate;
        eprintln!(
            "{name:40} tip {far:.1e} est {:.1e} ratio {ratio:.2} stations {worst:.1e} at {place:.3} el {} rounds {}",
            solved.error_estimate / arm.length,
            solved.statistics.elements,
            solved.statistics.newton_rounds
        );
        if far > 3e-8 {
            failed.push(name);
        }
    }
    assert!(failed.is_empty(), "{failed:?}");
}
