//! Tests what the lists of a curve and of its certificate claim of rows, vertices and places.

use std::collections::HashSet;

use taut::certify::{Curve, CurveCertificate};

use super::planar::Point;
use super::{Edge, Judged, ensure};

/// Equal points have equal keys: −0 is 0.
pub(super) fn key(p: Point) -> [u64; 2] {
    p.map(|x| (x + 0.0).to_bits())
}

pub(super) fn is_exact(curve: &Curve) -> bool {
    curve.curves.first().is_some_and(|one| !one.rows.is_empty())
}

pub(super) fn check(curve: &Curve, certificate: &CurveCertificate, rows: &[Point]) -> Judged {
    let count = rows.len() as u64;
    ensure(curve.outliers.is_sorted_by(|a, b| a < b), || "outliers are not ascending".into())?;
    ensure(curve.outliers.last().is_none_or(|&last| last < count), || {
        "an outlier is no row".into()
    })?;
    for figure in
        [curve.noise, certificate.band, certificate.sampling_ratio, certificate.noise_ratio]
    {
        ensure(figure >= 0.0 && figure.is_finite(), || format!("{figure} is no such figure"))?;
    }
    let is_exact = is_exact(curve);
    for (number, one) in curve.curves.iter().enumerate() {
        let least = if one.closed { 3 } else { 1 };
        ensure(one.vertices.len() >= least, || format!("curve {number} has too few vertices"))?;
        let all = one.vertices.iter().flatten();
        ensure(all.copied().all(f64::is_finite), || format!("curve {number} is not finite"))?;
        let expected = if is_exact { one.vertices.len() } else { 0 };
        ensure(one.rows.len() == expected, || format!("curve {number} has other rows"))?;
        for (&row, vertex) in one.rows.iter().zip(&one.vertices) {
            let at = usize::try_from(row).ok().and_then(|row| rows.get(row));
            ensure(at == Some(vertex), || format!("a vertex of curve {number} is not row {row}"))?;
            let is_outlier = curve.outliers.binary_search(&row).is_ok();
            ensure(!is_outlier, || format!("row {row} is a vertex and an outlier"))?;
        }
    }
    if is_exact {
        ensure(curve.noise == 0.0, || "vertices are rows, but there is noise".into())?;
        let vertices = || curve.curves.iter().flat_map(|one| &one.vertices);
        let places: HashSet<[u64; 2]> = vertices().map(|&vertex| key(vertex)).collect();
        ensure(places.len() == vertices().count(), || "two vertices are at one place".into())?;
        for (row, &p) in (0u64..).zip(rows) {
            let is_told = places.contains(&key(p)) || curve.outliers.binary_search(&row).is_ok();
            ensure(is_told, || format!("row {row} is no vertex and no outlier"))?;
        }
    }
    Ok(())
}

/// The share of the distance of the curve by which the place of a row may be farther off, and how many roundings of the
/// coordinates of the row and of its edge.
const PLACE_TOLERANCE: f64 = 1e-8;
const ROUNDINGS: f64 = 256.0;

/// Each place is on its curve, and no point of any curve is nearer to the row, up to the rounding of the coordinates near it.
pub(super) fn places(curve: &Curve, rows: &[Point], edges: &[Edge]) -> Judged {
    let places = &curve.places;
    ensure(places.is_empty() || places.len() == rows.len(), || "not a place for each row".into())?;
    for (row, (place, &p)) in places.iter().zip(rows).enumerate() {
        let of = place.0 as usize;
        let own: Vec<&Edge> = edges.iter().filter(|edge| edge.curve == of).collect();
        // A curve of one vertex has the position 0, and an edge from there to there.
        let most = match curve.curves.get(of) {
            Some(one) if one.closed => one.vertices.len() as f64,
            Some(one) => one.vertices.len() as f64 - 1.0,
            None => -1.0,
        };
        let is_there = place.1 >= 0.0 && place.1 <= most;
        ensure(is_there, || format!("row {row} has no place {place:?}"))?;
        let edge = own[(place.1 as usize).min(own.len() - 1)];
        let t = place.1 - edge.number as f64;
        // Coordinates of all sizes, so that squares stay in range.
        let coordinates = p.iter().chain(edge.ends.as_flattened());
        let size = coordinates.fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
        let claimed = apart(p, edge.ends, t);
        let nearest = edges.iter().map(|edge| apart(p, edge.ends, projection(p, edge.ends)));
        let nearest = nearest.fold(f64::INFINITY, f64::min);
        let [a, b] = edge.ends;
        let moved = place.1 * (b[0] / 2.0 - a[0] / 2.0).hypot(b[1] / 2.0 - a[1] / 2.0);
        let slack =
            PLACE_TOLERANCE * nearest + ROUNDINGS * f64::EPSILON * (size / 2.0 + nearest + moved);
        ensure(claimed <= nearest + slack, || {
            format!("the place of row {row} is {claimed:e} away, the curve {nearest:e}, in halves")
        })?;
    }
    Ok(())
}

/// Half the distance of p from the point of a segment at t: differences of any doubles stay in range.
pub(super) fn apart(p: Point, [a, b]: [Point; 2], t: f64) -> f64 {
    let [x, y] = [0, 1].map(|k| match t {
        1.0 => p[k] / 2.0 - b[k] / 2.0,
        t => (p[k] / 2.0 - a[k] / 2.0) - t * (b[k] / 2.0 - a[k] / 2.0),
    });
    x.hypot(y)
}

/// The share of a segment before the projection of p.
pub(super) fn projection(p: Point, [a, b]: [Point; 2]) -> f64 {
    let [e, r] = [b, p].map(|q| [0, 1].map(|k| q[k] / 2.0 - a[k] / 2.0));
    let size = e[0].abs().max(e[1].abs());
    if size == 0.0 {
        return 0.0;
    }
    // Shares of the longer side: neither overflows nor vanishes.
    let [e, r] = [e, r].map(|v| v.map(|x| x / size));
    ((e[0] * r[0] + e[1] * r[1]) / (e[0] * e[0] + e[1] * e[1])).clamp(0.0, 1.0)
}
