//! Layers in space: balls as spheres, ellipsoids as meridians and parallels about their longest axis.

use taut_certify::Items;

use super::plane::{LARGE_CORNERS, SMALL_CORNERS};
use super::{Layer, Marks};
use crate::body::length;
use crate::{Layer3, LineStyle, Point3, Shape3, Sphere3, Tone};

pub(crate) type Place = [f64; 3];

/// There are this many half-planes through the longest axis.
const MERIDIAN_COUNT: usize = 6;
/// There are this many circles around the longest axis on each side of the equator.
const PARALLEL_COUNT: usize = 2;

/// A net on {c + Σ yₖaₖ : |y| ≤ 1} for up to three half-axes aₖ; an ellipse, a segment or nothing for fewer.
fn net(center: Place, axes: &[Vec<f64>], part: f64, steps: usize, fine: bool) -> Vec<Vec<Place>> {
    let at = |y: [f64; 3]| {
        let sum = |k: usize| -> f64 { axes.iter().zip(y).map(|(axis, y)| axis[k] * y).sum() };
        [0, 1, 2].map(|k| center[k] + part * sum(k))
    };
    let ring = |place: &dyn Fn(f64, f64) -> [f64; 3]| -> Vec<Place> {
        let turn = |i: usize| (std::f64::consts::TAU * i as f64 / steps as f64).sin_cos();
        (0..=steps).map(|i| turn(i % steps)).map(|(sin, cos)| at(place(cos, sin))).collect()
    };
    match axes.len() {
        0 => vec![],
        1 => vec![vec![at([-1.0, 0.0, 0.0]), at([1.0, 0.0, 0.0])]],
        2 => vec![ring(&|cos, sin| [cos, sin, 0.0])],
        _ if !fine => vec![
            ring(&|cos, sin| [cos, sin, 0.0]),
            ring(&|cos, sin| [cos, 0.0, sin]),
            ring(&|cos, sin| [0.0, cos, sin]),
        ],
        _ => {
            let meridian = |i: usize| {
                let (s, c) = (std::f64::consts::PI * i as f64 / MERIDIAN_COUNT as f64).sin_cos();
                ring(&|cos, sin| [sin, c * cos, s * cos])
            };
            let parallel = |i: usize| {
                let step = i as f64 - PARALLEL_COUNT as f64;
                let (height, radius) =
                    (std::f64::consts::FRAC_PI_2 * step / (PARALLEL_COUNT + 1) as f64).sin_cos();
                ring(&|cos, sin| [height, radius * cos, radius * sin])
            };
            (0..MERIDIAN_COUNT)
                .map(meridian)
                .chain((0..2 * PARALLEL_COUNT + 1).map(parallel))
                .collect()
        }
    }
}

/// The half-axes of an ellipsoid given by its row, as columns of a triangular root of its shape.
fn root(row: &[f64]) -> Vec<Vec<f64>> {
    let mut l = vec![vec![0.0; 3]; 3];
    for j in 0..3 {
        for k in 0..=j {
            let shape = row[3 + j * (j + 1) / 2 + k];
            let rest: f64 = shape - (0..k).map(|i| l[j][i] * l[k][i]).sum::<f64>();
            l[j][k] = match (j == k, l[k][k]) {
                (true, _) => rest.max(0.0).sqrt(),
                (false, pivot) if pivot > 0.0 => rest / pivot,
                (false, _) => 0.0,
            };
        }
    }
    (0..3).map(|k| l.iter().map(|row| row[k]).collect()).collect()
}

/// A turn of the view, in whole degrees, that shows an axis from its side; 35 where it stands upright or there is none.
pub(super) fn azimuth(axis: Option<&[f64]>) -> f64 {
    let Some([x, y, z]) = axis.map(at) else { return 35.0 };
    let level = length(&[x, y]);
    if level > 0.25 * z.abs() { (y.atan2(x).to_degrees() + 70.0).round() } else { 35.0 }
}

pub(crate) fn at(row: &[f64]) -> Place {
    [row[0], row[1], row[2]]
}

pub(super) fn layer(Layer { name, tone, line_style, marks }: Layer<'_>) -> Layer3 {
    let thin = if line_style == LineStyle::Filled { LineStyle::Thin } else { line_style };
    let (line_style, shape) = match marks {
        Marks::Balls { centers, radius } => {
            let sphere = |center: &Vec<f64>| Sphere3 { id: None, center: at(center), radius };
            (line_style, Shape3::Spheres(centers.iter().map(sphere).collect()))
        }
        Marks::Ellipsoid { body, part } => {
            let is_second = tone == Tone::Second;
            let steps = if is_second { SMALL_CORNERS } else { LARGE_CORNERS / 2 };
            let net = net(at(&body.center), &body.principal(), part, steps, !is_second);
            (thin, Shape3::Polylines(net))
        }
        Marks::Items(group) => match group.items {
            Items::Points => {
                let point = |(id, row): (u64, &[f64])| Point3 {
                    id: Some(id),
                    at: at(row),
                    size: group.scale * group.size,
                    label: group.label.into(),
                };
                (line_style, Shape3::Points(group.each().map(point).collect()))
            }
            Items::Balls => {
                let ball = |(id, row): (u64, &[f64])| Sphere3 {
                    id: Some(id),
                    center: at(row),
                    radius: row[3],
                };
                (line_style, Shape3::Spheres(group.each().map(ball).collect()))
            }
            Items::Ellipsoids => {
                let net =
                    |(_, row): (u64, &[f64])| net(at(row), &root(row), 1.0, SMALL_CORNERS, false);
                (thin, Shape3::Polylines(group.each().flat_map(net).collect()))
            }
        },
        Marks::Points(marks) => {
            let point = |mark: super::Mark| Point3 {
                id: Some(mark.id),
                at: at(&mark.at),
                size: mark.size,
                label: mark.label,
            };
            (line_style, Shape3::Points(marks.into_iter().map(point).collect()))
        }
        Marks::Crosses(centers) => {
            (line_style, Shape3::Crosses(centers.iter().map(|c| at(c)).collect()))
        }
        Marks::Space(shape) => (line_style, shape),
        Marks::Plane(_) => (line_style, Shape3::Points(Vec::new())),
    };
    Layer3 { name, tone, line_style, shape }
}
