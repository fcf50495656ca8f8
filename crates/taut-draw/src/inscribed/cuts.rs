//! A polytope of more than three dimensions: cuts through the centre of the ellipsoid, and how near the half-spaces come.

use super::clip::{Polygon, polygon};
use super::{ELLIPSOID, Picture};
use crate::ellipsoid::body::Shadow;
use crate::ellipsoid::pairs::{PANEL_HALF_WIDTH, coordinates, diagonal, panels, square};
use crate::ellipsoid::plane::LARGE_CORNERS;
use crate::{
    Aspect, Axis, Layer2, Level, Look, Plot, Scale, Scene2, Series, SeriesLook, Shape2, Tone,
};

/// This part of a panel is filled.
const FILLED_PART: f64 = 0.94;

impl Picture<'_> {
    /// d > 3, all panels in one picture. Every panel is scaled so that the cut of the polytope fills it.
    pub(super) fn cuts(&self) -> Scene2 {
        let chosen = coordinates(&self.body);
        let panels = panels(&chosen);
        let (mut polytopes, mut ellipses, mut is_whole) = (Vec::new(), Vec::new(), true);
        for panel in &panels {
            let (j, k) = (panel.j, panel.k);
            let Shadow([[wide, _], [slope, tall]]) = self.body.cut(j, k);
            // In coordinates z of v = Lz the cut of the ellipsoid is the unit disc.
            let half_planes: Vec<_> = (self.sides.near.iter())
                .map(|side| {
                    let (a, b) = (side.normal[j], side.normal[k]);
                    ([a * wide + b * slope, b * tall], side.slack)
                })
                .filter(|(normal, _)| normal.iter().any(|&v| v != 0.0))
                .map(|([a, b], slack)| {
                    let size = a.hypot(b);
                    ([a / size, b / size], slack / size)
                })
                .collect();
            let Polygon { corners, is_whole: ends } =
                polygon(&half_planes, 2.0 * self.dim() as f64);
            is_whole &= ends;
            let corners: Vec<[f64; 2]> =
                corners.iter().map(|[x, y]| [wide * x, slope * x + tall * y]).collect();
            let most = |k: usize| corners.iter().fold(0.0f64, |m, v| m.max(v[k].abs()));
            let scale = [most(0), most(1)].map(|most| if most > 0.0 { most } else { 1.0 });
            let [x, y] = scale.map(|most| FILLED_PART * PANEL_HALF_WIDTH / most);
            let [a, b] = panel.middle;
            polytopes.push(corners.iter().map(|v| [a + v[0] * x, b + v[1] * y]).collect());
            let cut = Shadow([[wide * x, 0.0], [slope * y, tall * y]]);
            ellipses.push(cut.chain(panel.middle, 1.0, LARGE_CORNERS));
        }
        let frames = panels.iter().map(|panel| square(panel.middle)).collect();
        let layer = |name: &str, tone, look, shape| Layer2 { name: name.into(), tone, look, shape };
        let layers = vec![
            layer("", Tone::Muted, Look::Thin, Shape2::Polygons(frames)),
            layer("polytope", Tone::Point, Look::Filled, Shape2::Polygons(polytopes)),
            layer(ELLIPSOID, Tone::Answer, Look::Filled, Shape2::Polygons(ellipses)),
            layer(
                "",
                Tone::Ink,
                Look::Solid,
                Shape2::Texts(diagonal(&self.body, &chosen, self.options)),
            ),
        ];
        let side = self.options.width.max(self.options.height);
        let choice = match chosen.len() == self.dim() {
            true => String::new(),
            false => format!(
                " {} of {} coordinates are drawn, those in which the ellipsoid is tilted most.",
                chosen.len(),
                self.dim()
            ),
        };
        Scene2 {
            title: self.title(),
            caption: format!(
                "{} Cuts through the centre along pairs of coordinates, each scaled to fill its panel; on the diagonal, \
                 the range of the coordinate over the ellipsoid.{choice}",
                self.caption(is_whole)
            ),
            x: Axis::default(),
            y: Axis::default(),
            aspect: Aspect::Equal,
            layers,
            width: side,
            height: side,
        }
    }

    /// d > 3: h of each half-space, the nearest first.
    pub(super) fn distances(&self) -> Plot {
        let (mut touching, mut others) = (Vec::new(), Vec::new());
        for (place, side) in self.sides.near.iter().enumerate() {
            let list = if side.weight > 0.0 { &mut touching } else { &mut others };
            list.push([(place + 1) as f64, side.distance]);
        }
        let series = |name: String, tone, points| {
            let look = SeriesLook::Dots;
            Series { name, tone, look, points }
        };
        Plot {
            title: "How near the half-spaces come".into(),
            caption: format!(
                "{} The distance of a half-space from the centre is counted in the metric of the ellipsoid.",
                self.nearness()
            ),
            x: Axis::named("half-spaces, the nearest first"),
            y: Axis::named("distance: 1 touches"),
            x_scale: Scale::Linear,
            y_scale: Scale::Log,
            series: vec![
                series("others".into(), Tone::Point, others),
                series(self.touching_name(), Tone::Support, touching),
            ],
            bars: Vec::new(),
            levels: vec![Level::AtY { y: 1.0, tone: Tone::Answer, label: "border".into() }],
            width: self.options.width,
            height: (self.options.height * 0.62).max(180.0),
        }
    }
}
