//! Largest rectangles along the axes: closed forms, laws, brute force, and mutations of the certificate.

use super::common::{Ring, comb, star_shaped, tour};
use super::rings::{rows, square};
use taut_certify::{CheckError, InscribedRectangle, RectangleVerdict, Solution, Stop};
use taut_inscribe::{Error, RectangleOptions, inscribed_rectangle};
use taut_points::Points;

fn solve(rings: &[Ring], epsilon: f64) -> Result<Solution<InscribedRectangle>, Error> {
    let options = RectangleOptions { epsilon, ..Default::default() };
    inscribed_rectangle(&Points::new(&rows(rings), 3).unwrap(), &options)
}

fn check(
    found: &Solution<InscribedRectangle>,
    rings: &[Ring],
) -> Result<RectangleVerdict, CheckError> {
    found.check(&Points::new(&rows(rings), 3).unwrap())
}

fn proved(rings: &[Ring], epsilon: f64) -> Solution<InscribedRectangle> {
    let found = solve(rings, epsilon).unwrap();
    let verdict = check(&found, rings);
    let verdict = verdict.unwrap_or_else(|error| panic!("{error}: {:?}, {rings:?}", found.answer));
    assert_eq!(found.trace.stop, Stop::Converged, "{rings:?}: {verdict:?}");
    assert!(verdict.gap <= epsilon * (1.0 + 1e-8), "{verdict:?}");
    found
}

fn assert_area(rings: &[Ring], epsilon: f64, expected: f64) {
    let area = proved(rings, epsilon).answer.area;
    let is_near = area <= expected * (1.0 + 1e-12) && area * (1.0 + 1.1 * epsilon) >= expected;
    assert!(is_near, "{area} instead of {expected}: {rings:?}");
}

#[test]
fn closed_forms_are_found() {
    assert_area(&[square(-1.0, 2.0, 3.0)], 1e-6, 9.0);
    let l = vec![[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    assert_area(&[l], 1e-6, 3.0);
    assert_area(&[square(0.0, 0.0, 4.0), square(1.0, 1.0, 2.0)], 1e-6, 4.0);
    assert_area(&[square(0.0, 0.0, 4.0), square(2.0, 1.0, 1.5)], 1e-6, 8.0);
    assert_area(&[comb(5, 1.5)], 1e-6, 9.0);
    assert_area(&[square(0.0, 0.0, 1.0), square(5.0, 0.0, 3.0)], 1e-6, 9.0);
    // Half of a right triangle, of a rhombus, and 2/π of a disk.
    assert_area(&[vec![[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]]], 1e-4, 3.0);
    assert_area(&[vec![[2.0, 0.0], [0.0, 1.0], [-2.0, 0.0], [0.0, -1.0]]], 1e-4, 2.0);
    let disk: Ring = (0..200)
        .map(|i| (std::f64::consts::TAU * (f64::from(i) + 0.5) / 200.0).sin_cos())
        .map(|(y, x)| [5.0 * x, 0.01 * y])
        .collect();
    let found = proved(&[disk], 1e-3).answer.area;
    assert!((found / 0.1 - 1.0).abs() < 2e-3, "{found}");
}

#[test]
fn images_along_the_axes_have_the_image_of_the_answer() {
    let ring = tour(4, 14);
    let before = proved(std::slice::from_ref(&ring), 1e-3).answer.area;
    for scale in [[3.0, 0.5], [1e-120, 1e20], [-1.0, 1.0], [1e150, 1e150]] {
        let image: Ring = ring.iter().map(|p| [scale[0] * p[0], scale[1] * p[1]]).collect();
        let after = proved(&[image], 1e-3).answer.area / (scale[0] * scale[1]).abs();
        assert!((after / before - 1.0).abs() < 1.1e-3, "{after} and {before}: {scale:?}");
    }
    let turned: Ring = ring.iter().map(|p| [-p[1], p[0]]).collect();
    let after = proved(&[turned], 1e-3).answer.area;
    assert!((after / before - 1.0).abs() < 1.1e-3, "{after} and {before}");
}

#[test]
fn no_rectangle_of_a_grid_is_larger() {
    for seed in 0..12 {
        let size = 5 + (seed as usize) % 8;
        let ring = if seed % 2 == 0 { tour(seed, size) } else { star_shaped(seed, size) };
        let found = solve(std::slice::from_ref(&ring), 1e-3).unwrap();
        let verdict = check(&found, std::slice::from_ref(&ring)).unwrap();
        let best = best_of_grid(&ring, 24);
        assert!(best <= verdict.upper * (1.0 + 1e-9), "{best} and {verdict:?}: {ring:?}");
        assert!(verdict.gap <= 2e-2, "{verdict:?}: {ring:?}");
    }
}

/// The largest rectangle whose sides are on lines of a grid and whose cells are all inside: its corners, middles and sides are.
fn best_of_grid(ring: &[[f64; 2]], lines: usize) -> f64 {
    let fold =
        |k: usize, most: fn(f64, f64) -> f64| ring.iter().map(|p| p[k]).reduce(most).unwrap();
    let low = [fold(0, f64::min), fold(1, f64::min)];
    let high = [fold(0, f64::max), fold(1, f64::max)];
    let at = |k: usize, i: usize| low[k] + (high[k] - low[k]) * i as f64 / lines as f64;
    let n = ring.len();
    let is_free = |i: usize, j: usize| {
        let cell = [[at(0, i), at(1, j)], [at(0, i + 1), at(1, j + 1)]];
        let middle = [0, 1].map(|k| 0.5 * (cell[0][k] + cell[1][k]));
        super::common::is_inside(middle, ring)
            && (0..n).all(|e| !enters(cell, ring[e], ring[(e + 1) % n]))
    };
    let free: Vec<bool> = (0..lines * lines).map(|c| is_free(c / lines, c % lines)).collect();
    let mut most = 0.0f64;
    for i in 0..lines {
        // Cells of a column range that are free in all of its columns.
        let mut all = vec![true; lines];
        for k in i..lines {
            for (j, cell) in all.iter_mut().enumerate() {
                *cell &= free[k * lines + j];
            }
            for run in all.split(|&cell| !cell).map(<[bool]>::len) {
                let share = (run * (k + 1 - i)) as f64 / (lines * lines) as f64;
                most = most.max(share * (high[0] - low[0]) * (high[1] - low[1]));
            }
        }
    }
    most
}

/// Whether a segment enters an open rectangle, in plain arithmetic.
fn enters([low, high]: [[f64; 2]; 2], a: [f64; 2], b: [f64; 2]) -> bool {
    let (mut from, mut to) = (0.0f64, 1.0f64);
    for k in 0..2 {
        for (here, there) in [(a[k] - low[k], b[k] - low[k]), (high[k] - a[k], high[k] - b[k])] {
            if here <= 0.0 && there <= 0.0 {
                return false;
            }
            let share = here / (here - there);
            if here > 0.0 && there <= 0.0 {
                to = to.min(share);
            } else if here <= 0.0 {
                from = from.max(share);
            }
        }
    }
    from < to
}

#[test]
fn a_budget_is_kept_and_bad_input_is_refused() {
    let rings = [tour(9, 30)];
    let values = rows(&rings);
    let source = Points::new(&values, 3).unwrap();
    for max_cells in [1, 2, 3, 100] {
        let options = RectangleOptions { max_cells, ..Default::default() };
        let found = inscribed_rectangle(&source, &options).unwrap();
        assert!(found.certificate.tree.len() as u64 <= max_cells);
        assert_eq!(found.trace.stop, Stop::NodeBudget);
        found.check(&source).unwrap();
    }
    let options = RectangleOptions { max_cells: 0, ..Default::default() };
    assert!(matches!(inscribed_rectangle(&source, &options), Err(Error::Input(_))));
    assert!(matches!(solve(&rings, 1.0), Err(Error::Input(_))));
    let crossed = vec![[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
    assert!(matches!(solve(&[crossed], 1e-3), Err(Error::NotSimple { .. })));
    for scale in [1e200, 1e-200] {
        let image: Ring = square(0.0, 0.0, 1.0).iter().map(|p| p.map(|x| x * scale)).collect();
        assert!(matches!(solve(&[image], 1e-3), Err(Error::Area)));
    }
}

#[test]
fn every_change_of_answer_or_proof_is_refused() {
    let rings = [tour(6, 12)];
    let found = proved(&rings, 1e-2);
    let is_refused = |change: &dyn Fn(&mut Solution<InscribedRectangle>)| {
        let mut changed = found.clone();
        change(&mut changed);
        let verdict = check(&changed, &rings);
        matches!(verdict, Err(CheckError::Rejected(_)))
    };
    for k in 0..2 {
        assert!(is_refused(&|f| f.answer.low[k] -= 0.01));
        assert!(is_refused(&|f| f.answer.high[k] += 0.01));
        assert!(is_refused(&|f| f.answer.low[k] = f.answer.high[k]));
        assert!(is_refused(&|f| f.answer.high[k] = f64::NAN));
    }
    assert!(is_refused(&|f| f.answer.area *= 1.0 + 1e-12));
    assert!(is_refused(&|f| f.certificate.gap *= 0.9));
    assert!(is_refused(&|f| f.certificate.gap = f64::INFINITY));
    assert!(is_refused(&|f| _ = f.certificate.edges.pop()));
    assert!(is_refused(&|f| f.certificate.edges.push(0)));
    assert!(is_refused(&|f| f.certificate.edges[0] = 1 << 40));
    assert!(is_refused(&|f| f.certificate.tree.push('m')));
    assert!(is_refused(&|f| _ = f.certificate.tree.pop()));
    // A reason put in the place of another one holds by chance at most.
    let (mut refused, mut tried) = (0, 0);
    for position in (0..found.certificate.tree.len()).step_by(7) {
        for letter in "lbrtme1234".chars() {
            let of = position..position + 1;
            if found.certificate.tree[of.clone()] == letter.to_string() {
                continue;
            }
            tried += 1;
            refused += usize::from(is_refused(&|f| {
                f.certificate.tree.replace_range(of.clone(), &letter.to_string());
            }));
        }
    }
    assert!(refused * 100 >= tried * 97, "{refused} of {tried}");
}

#[test]
fn a_corner_is_not_called_outside_where_no_rectangle_has_it() {
    // The fuzzed ring whose certificate the checker refused: ranges of opposite sides that overlap.
    let ring = vec![[1.0, 3.0], [5.0, 5.0], [3.0, 3.0], [3.0, 2.0], [1.0, 1.0], [0.0, 5.0]];
    proved(&[ring], 0.1);
    // Left in [4, 6], right in [4, 8], bottom in [2, 4], top in [0, 4]: the upper left corner is at (4, 2) or beyond, which is inside, and
    // not at (4, 0), which is outside. The edge between these is no edge of the hull of the parent.
    let ring = vec![[0.0, 0.0], [1.0, 1.0], [8.0, 1.0], [8.0, 8.0], [0.0, 8.0]];
    let mut found = proved(std::slice::from_ref(&ring), 0.1);
    found.certificate.gap = 1.0;
    found.certificate.edges.clear();
    found.certificate.tree = "bbmtlmlrmmmmm".to_owned();
    assert!(check(&found, std::slice::from_ref(&ring)).is_ok());
    found.certificate.tree = "bbmtlmlrm4mmm".to_owned();
    let error = check(&found, &[ring]).unwrap_err().to_string();
    assert!(error.contains("calls a corner outside that is inside"), "{error}");
}
