//! Tests what must not change the answer, or change it in a known way.

use super::common::{Ring, proved, solve, solve_with, star_shaped, tour, verify};
use taut_certify::{AnySolution, Stop};
use taut_inscribe::CircleOptions;

fn rings() -> Vec<Ring> {
    let stars = (0..6).map(|seed| star_shaped(70 + seed, 6 + 7 * seed as usize));
    stars.chain((0..6).map(|seed| tour(80 + seed, 6 + 7 * seed as usize))).collect()
}

/// Two radii with a gap of 1e-9 each, and `slack` for rounded coordinates.
fn assert_close(one: f64, other: f64, slack: f64) {
    assert!((one / other - 1.0).abs() <= 1.01e-9 + slack, "{one} and {other}");
}

#[test]
fn powers_of_two_scale_everything() {
    for ring in rings() {
        let (found, _) = proved(&ring);
        for factor in [2f64.powi(-900), 0.125, 4.0, 2f64.powi(1000)] {
            let scaled: Ring = ring.iter().map(|p| p.map(|x| x * factor)).collect();
            let (other, _) = proved(&scaled);
            assert_eq!(other.answer.radius, found.answer.radius * factor);
            assert_eq!(other.answer.center, found.answer.center.map(|x| x * factor));
            assert_eq!(other.certificate.tree, found.certificate.tree);
        }
    }
}

#[test]
fn other_scales_turns_and_shifts_keep_the_circle() {
    let (sine, cosine) = 1.0f64.sin_cos();
    for ring in rings() {
        let radius = proved(&ring).0.answer.radius;
        for factor in [1e-150, 1e150] {
            let scaled: Ring = ring.iter().map(|p| p.map(|x| x * factor)).collect();
            assert_close(proved(&scaled).0.answer.radius / factor, radius, 1e-13);
        }
        let turned: Ring = ring
            .iter()
            .map(|p| [cosine * p[0] - sine * p[1], sine * p[0] + cosine * p[1]])
            .collect();
        assert_close(proved(&turned).0.answer.radius, radius, 1e-12);
        let shifted: Ring = ring.iter().map(|p| [p[0] + 100.0, p[1] - 77.0]).collect();
        assert_close(proved(&shifted).0.answer.radius, radius, 1e-10);
    }
}

#[test]
fn where_the_ring_begins_and_ends_does_not_matter() {
    for ring in rings() {
        let radius = proved(&ring).0.answer.radius;
        let mut other = ring.clone();
        other.rotate_left(ring.len() / 2);
        assert_close(proved(&other).0.answer.radius, radius, 0.0);
        other.reverse();
        assert_close(proved(&other).0.answer.radius, radius, 0.0);
        let closed: Ring = ring.iter().chain(&ring[..1]).copied().collect();
        let (found, _) = proved(&closed);
        assert_eq!(found.answer.radius, radius);
        let repeated: Ring = ring.iter().flat_map(|&p| [p, p, p]).collect();
        let (found, _) = proved(&repeated);
        assert_eq!(found.answer.radius, radius);
        // An edge is named by the last of its equal rows.
        assert!(found.certificate.touching.iter().all(|row| row % 3 == 2));
    }
}

#[test]
fn subdivided_edges_are_the_same_edges() {
    // Small whole numbers, so that the middles of edges are on them.
    for ring in rings() {
        let ring: Ring = ring.iter().map(|p| p.map(|x| (x * 1024.0).round() * 2.0)).collect();
        let (Ok(found), after) = (solve(&ring), ring[1..].iter().chain(&ring[..1])) else {
            continue;
        };
        let middle = |p: &[f64; 2], q: &[f64; 2]| [0, 1].map(|k| (p[k] + q[k]) / 2.0);
        let halves: Ring = ring.iter().zip(after).flat_map(|(p, q)| [*p, middle(p, q)]).collect();
        assert_close(proved(&halves).0.answer.radius, found.answer.radius, 1e-13);
    }
}

#[test]
fn the_same_ring_gives_the_same_bytes() {
    for ring in rings() {
        let text = solve(&ring).unwrap().to_json();
        assert_eq!(solve(&ring).unwrap().to_json(), text);
        assert_eq!(AnySolution::from_json(&text).unwrap().to_json(), text);
    }
}

#[test]
fn larger_gaps_take_fewer_cells() {
    for ring in rings() {
        let (tight, _) = proved(&ring);
        let options = CircleOptions { epsilon: 0.2, ..Default::default() };
        let loose = solve_with(&ring, &options).unwrap();
        let gap = verify(&loose, &ring).gap;
        assert!(gap <= 0.2 * (1.0 + 1e-9), "{gap}");
        assert!(loose.certificate.tree.len() <= tight.certificate.tree.len());
        assert!(loose.answer.radius * (1.0 + gap) >= tight.answer.radius * (1.0 - 1e-14));
        let options = CircleOptions { epsilon: 1e-13, ..Default::default() };
        let tighter = solve_with(&ring, &options).unwrap();
        assert!(verify(&tighter, &ring).gap <= 1.1e-13);
    }
}

#[test]
fn a_budget_ends_in_a_true_gap() {
    for ring in rings() {
        for max_cells in [1, 10, 30] {
            let options = CircleOptions { max_cells, ..Default::default() };
            let found = solve_with(&ring, &options).unwrap();
            let verdict = verify(&found, &ring);
            assert!(found.certificate.tree.len() as u64 <= max_cells);
            let (exact, _) = proved(&ring);
            assert!(verdict.upper >= exact.answer.radius);
            if verdict.gap > 1.1e-9 {
                assert_eq!(found.trace.stop, Stop::NodeBudget);
            }
        }
    }
}
