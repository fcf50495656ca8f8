//! Dense samples of random smooth curves give exactly the edges between neighbors, as each method promises.

use taut_points::{
    Points,
    generate::curves::{TestCurve, epsilon_sample},
};
use taut_reconstruct::{CurveMethod, CurveOptions, Ends, curve};

#[test]
fn dense_samples_give_exactly_the_true_edges() {
    for seed in 0..40 {
        let truth = TestCurve::random(seed).build_with(2000);
        for (method, epsilon) in [
            (CurveMethod::NnCrust, 0.33),
            (CurveMethod::Crust, 0.25),
            (CurveMethod::HnnCrust, 0.45),
            (CurveMethod::OneStepCrust, 0.42),
            (CurveMethod::Corners, 0.25),
        ] {
            let sample = epsilon_sample(&truth, epsilon, seed);
            let points = Points::new(&sample.points, 2).expect("whole rows");
            let options = CurveOptions { method, ends: Ends::Open, ..Default::default() };
            let found = curve(&points, &options).expect("finite points").answer;
            let mut edges: Vec<[u32; 2]> = Vec::new();
            for component in &found.curves {
                let next = component.rows.iter().cycle().skip(1);
                let count = component.rows.len() - usize::from(!component.closed);
                for (&a, &b) in component.rows.iter().zip(next).take(count) {
                    edges.push([a.min(b) as u32, a.max(b) as u32]);
                }
            }
            edges.sort_unstable();
            assert_eq!(edges, sample.edges, "{method:?}, seed {seed}");
        }
    }
}
