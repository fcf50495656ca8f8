//! A polytope of more than three dimensions: cuts through the center of the ellipsoid, and how near the half-spaces come.

use super::clip::{Polygon, polygon};
use super::{ELLIPSOID, Picture};
use crate::body::Shadow;
use crate::scene::LARGE_CORNERS;
use crate::scene::pairs::{PANEL_HALF_WIDTH, choice, coordinates, framed, panels};
use crate::{Axis, Layer2, Level, LineStyle, Plot, Scale, Scene2, Series, Shape2, Tone};

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
        let layer = |name: &str, tone, shape| Layer2 {
            name: name.into(),
            tone,
            line_style: LineStyle::Filled,
            shape,
        };
        let layers = [
            layer("polytope", Tone::Point, Shape2::Polygons(polytopes)),
            layer(ELLIPSOID, Tone::Answer, Shape2::Polygons(ellipses)),
        ];
        let caption = format!(
            "{} Cuts through the center along pairs of coordinates, each scaled to fill its panel; on the diagonal, \
             the range of the coordinate over the ellipsoid.{}",
            self.caption(is_whole),
            choice(&chosen, self.dim(), "in which the ellipsoid is tilted most"),
        );
        let layers = framed(&self.body, &chosen, self.options, layers);
        Scene2::square(self.title(), caption, layers, self.options)
    }

    /// d > 3: h of each half-space, the nearest first.
    pub(super) fn distances(&self) -> Plot {
        let (mut touching, mut others) = (Vec::new(), Vec::new());
        for (place, side) in self.sides.near.iter().enumerate() {
            let list = if side.weight > 0.0 { &mut touching } else { &mut others };
            list.push([(place + 1) as f64, side.distance]);
        }
        let caption = format!(
            "{} The distance of a half-space from the center is counted in the metric of the ellipsoid.",
            self.nearness()
        );
        let axes = ["half-spaces, the nearest first", "distance: 1 touches"].map(Axis::named);
        Plot {
            y_scale: Scale::Log,
            series: vec![
                Series::dots("others".into(), Tone::Point, others),
                Series::dots(self.touching_name(), Tone::Support, touching),
            ],
            levels: vec![Level::AtY { y: 1.0, tone: Tone::Answer, label: "border".into() }],
            ..Plot::empty("How near the half-spaces come".into(), caption, axes, self.options)
        }
    }
}
