//! An ellipsoid of three dimensions, to be turned: its surface as meridians and parallels about its longest axis.

use taut_certify::Items;
use taut_points::gather;

use super::Picture;
use super::plane::{LARGE_CORNERS, LEFT_OUT_SCALE, SMALL_CORNERS};
use super::robust::KEPT_LABEL;
use crate::{Error, Layer3, Look, Point3, Projection, Scene3, Shape3, Sphere3, Tone};

pub(crate) type Place = [f64; 3];

/// There are this many half-planes through the longest axis.
const MERIDIAN_COUNT: usize = 6;
/// There are this many circles around the longest axis on each side of the equator.
const PARALLEL_COUNT: usize = 2;

/// A net on {c + Σ yₖaₖ : |y| ≤ 1} for up to three half-axes aₖ; an ellipse, a segment or nothing for fewer.
pub(crate) fn net(
    center: Place,
    axes: &[Vec<f64>],
    part: f64,
    steps: usize,
    fine: bool,
) -> Vec<Vec<Place>> {
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

/// The half-axes of an item, as columns of a triangular root of its shape.
fn root(items: Items, row: &[f64]) -> Vec<Vec<f64>> {
    let mut l = vec![vec![0.0; 3]; 3];
    for j in 0..3 {
        for k in 0..=j {
            let shape = match items {
                Items::Points => 0.0,
                Items::Balls => {
                    if j == k {
                        row[3] * row[3]
                    } else {
                        0.0
                    }
                }
                Items::Ellipsoids => row[3 + j * (j + 1) / 2 + k],
            };
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

/// A turn of the view, in whole degrees, that shows the longest axis from its side; 35 where it stands upright.
pub(crate) fn azimuth(axes: &[Vec<f64>]) -> f64 {
    let Some([x, y, z]) = axes.first().map(|axis| at(axis)) else { return 35.0 };
    let level = super::body::length(&[x, y]);
    if level > 0.25 * z.abs() { (y.atan2(x).to_degrees() + 70.0).round() } else { 35.0 }
}

pub(crate) fn at(row: &[f64]) -> Place {
    [row[0], row[1], row[2]]
}

impl Picture<'_> {
    /// d = 3: to be turned.
    pub(super) fn space(&self) -> Result<Scene3, Error> {
        let center = at(&self.body.center);
        let axes = self.body.principal();
        let surface = |name: &str, tone, look, part| Layer3 {
            name: name.into(),
            tone,
            look,
            shape: Shape3::Polylines(net(center, &axes, part, LARGE_CORNERS / 2, true)),
        };
        let mut layers = vec![surface(&self.name(), Tone::Answer, Look::Thin, 1.0)];
        if let Some(second) = self.second() {
            let net = net(at(&second.center), &second.principal(), 1.0, SMALL_CORNERS, false);
            let (name, shape) = (KEPT_LABEL.into(), Shape3::Polylines(net));
            layers.push(Layer3 { name, tone: Tone::Second, look: Look::Dashed, shape });
        }
        let (inside, out) = self.others();
        let size = self.dot_size();
        layers.extend(self.bodies(&inside, self.others_name(), Tone::Point, size)?);
        layers.extend(self.bodies(
            &out,
            self.left_out_name(),
            Tone::Third,
            LEFT_OUT_SCALE * size,
        )?);
        if self.lower_is_visible() {
            layers.push(surface("lower bound", Tone::Bound, Look::Dashed, self.lower()));
        }
        let mark = |mark: super::Mark| Point3 {
            id: Some(mark.id),
            at: at(&mark.at),
            size: mark.size,
            label: mark.label,
        };
        let marks: Vec<Point3> = self.support()?.into_iter().map(mark).collect();
        layers.extend((!marks.is_empty()).then(|| Layer3 {
            name: self.support_name(),
            tone: Tone::Support,
            look: Look::Solid,
            shape: Shape3::Points(marks),
        }));
        layers.push(Layer3 {
            name: "centre".into(),
            tone: Tone::Ink,
            look: Look::Solid,
            shape: Shape3::Crosses(vec![center]),
        });
        Ok(Scene3 {
            title: self.title(),
            caption: self.facts() + &self.counts(),
            axes: [0, 1, 2].map(|k| self.options.axis(k, 3)),
            layers,
            projection: Projection::Perspective,
            azimuth: azimuth(&self.aside(&out)?.map_or(axes, |aside| vec![aside])),
            elevation: 22.0,
            width: self.options.width,
            height: self.options.height,
        })
    }

    /// Where the outliers lie on average, as seen from the centre: the view is to show that from its side.
    fn aside(&self, out: &[u64]) -> Result<Option<Vec<f64>>, Error> {
        if self.robust.is_none() || out.is_empty() {
            return Ok(None);
        }
        let rows = gather(self.source, out)?;
        let mean = |k: usize| {
            let offsets = rows[k..].iter().step_by(3).map(|x| x - self.body.center[k]);
            offsets.sum::<f64>() / out.len() as f64
        };
        Ok(Some([0, 1, 2].map(mean).to_vec()))
    }

    /// Items as discs, spheres or nets.
    fn bodies(
        &self,
        ids: &[u64],
        name: String,
        tone: Tone,
        size: f64,
    ) -> Result<Option<Layer3>, Error> {
        if ids.is_empty() {
            return Ok(None);
        }
        let rows = gather(self.source, ids)?;
        let rows = ids.iter().zip(rows.chunks_exact(self.source.dim()));
        let items = self.certificate().items;
        let (look, shape) = match items {
            Items::Points => {
                let point = |(&id, row): (&u64, &[f64])| Point3 {
                    id: Some(id),
                    at: at(row),
                    size,
                    label: String::new(),
                };
                (Look::Filled, Shape3::Points(rows.map(point).collect()))
            }
            Items::Balls => {
                let ball = |(&id, row): (&u64, &[f64])| Sphere3 {
                    id: Some(id),
                    center: at(row),
                    radius: row[3],
                };
                (Look::Filled, Shape3::Spheres(rows.map(ball).collect()))
            }
            Items::Ellipsoids => {
                let net = |(_, row): (&u64, &[f64])| {
                    net(at(row), &root(items, row), 1.0, SMALL_CORNERS, false)
                };
                (Look::Thin, Shape3::Polylines(rows.flat_map(net).collect()))
            }
        };
        Ok(Some(Layer3 { name, tone, look, shape }))
    }
}
