//! dev
#![allow(missing_docs)]
use taut_mesh::{Polyline, compare};
use taut_points::generate::curves::{CurveNoise, TestCurve, sample_curve};
use taut_reconstruct::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let delta: f64 = a[3].parse().unwrap();
    let outliers: f64 = a[4].parse().unwrap();
    let seeds: u64 = a[5].parse().unwrap();
    let gaussian = a.len() > 6 && a[6] == "g";
    for name in a[1].split(',') {
        let truth = if let Some(s) = name.strip_prefix("random") {
            TestCurve::random(s.parse().unwrap())
        } else {
            TestCurve::named(name).unwrap()
        }
        .build();
        let n = if let Some(k) = a[2].strip_suffix('L') {
            (k.parse::<f64>().unwrap() * truth.length_over_feature).ceil() as usize
        } else {
            a[2].parse().unwrap()
        };
        let (mut rms, mut good, mut time, mut h, mut bad, mut nv) =
            (vec![], 0, 0.0f64, 0.0f64, vec![], 0);
        for seed in 1..=seeds {
            let s = sample_curve(
                &truth,
                n,
                &CurveNoise { delta, gaussian, outliers, ..Default::default() },
                seed,
            );
            let p = taut_points::Points::new(&s.points, 2).unwrap();
            let t = std::time::Instant::now();
            let found = curve(&p, &CurveOptions { method: CurveMethod::Fit, ..Default::default() })
                .unwrap();
            time = time.max(t.elapsed().as_secs_f64());
            let tl: Vec<_> =
                truth.loops.iter().map(|l| Polyline { vertices: l, closed: true }).collect();
            let fl: Vec<_> = found
                .answer
                .curves
                .iter()
                .map(|l| Polyline { vertices: &l.vertices, closed: l.closed })
                .collect();
            nv = fl.iter().map(|f| f.vertices.len()).sum();
            let q = compare(&tl, &fl);
            if q.topology_right() {
                good += 1
            } else {
                bad.push((
                    seed,
                    q.loops_found,
                    q.crossings,
                    q.homeomorphic,
                    found
                        .answer
                        .curves
                        .iter()
                        .map(|c| (c.vertices.len(), c.closed))
                        .take(5)
                        .collect::<Vec<_>>(),
                ))
            }
            rms.push(q.vertex_rms);
            h = h.max(q.hausdorff);
            if seed == 1 {
                println!(
                    "   {:?} noise {:.5} outliers {}",
                    found.trace.counters,
                    found.answer.noise,
                    found.answer.outliers.len()
                );
            }
        }
        rms.sort_by(f64::total_cmp);
        println!(
            "{name} n={n} delta={delta} rms med {:.6} max {:.6} H max {:.5} good {good}/{seeds} time max {:.1} ms vertices {nv} bad {:?}",
            rms[rms.len() / 2],
            rms[rms.len() - 1],
            h,
            time * 1e3,
            &bad[..bad.len().min(4)]
        );
    }
}
