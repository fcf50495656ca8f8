//! A part of a picture in which the band of noise can be seen.

use super::Picture;

/// A window is this many half-widths of the band wide.
const WINDOW_HALF_WIDTHS: f64 = 60.0;
/// A band of fewer pixels from border to border is too narrow to see.
const BAND_PIXELS_MIN: f64 = 14.0;

/// A square.
pub(super) struct Window {
    center: [f64; 2],
    half: f64,
}

impl Picture<'_> {
    /// A square around a vertex of the curve with the most vertices, if the whole is too large to show its band.
    pub(super) fn window(&self) -> Option<Window> {
        let noise = self.answer.noise;
        let extent = self.extent();
        let pixels = 2.0 * noise / extent * self.options.width.min(self.options.height);
        let side = WINDOW_HALF_WIDTHS * noise;
        // Comparisons that hold of no NaN.
        if !(noise > 0.0 && pixels < BAND_PIXELS_MIN && side < extent) {
            return None;
        }
        let longest = self.answer.curves.iter().rev().max_by_key(|curve| curve.vertices.len())?;
        let center = *longest.vertices.get(longest.vertices.len() / 3)?;
        Some(Window { center, half: side / 2.0 })
    }
}

impl Window {
    pub(super) fn side(&self) -> f64 {
        2.0 * self.half
    }

    pub(super) fn holds(&self, at: [f64; 2]) -> bool {
        (0..2).all(|k| (at[k] - self.center[k]).abs() <= self.half)
    }

    /// The parts of a polyline within.
    pub(super) fn pieces(&self, vertices: &[[f64; 2]], closed: bool) -> Vec<Vec<[f64; 2]>> {
        let mut pieces: Vec<Vec<[f64; 2]>> = Vec::new();
        let back = if closed { vertices.first() } else { None };
        let mut chain = vertices.iter().chain(back);
        let Some(mut from) = chain.next().copied() else { return pieces };
        let mut going_on = false;
        for &to in chain {
            match self.cut(from, to) {
                Some([start, end]) => {
                    match pieces.last_mut() {
                        Some(piece) if going_on => piece.push(end),
                        _ => pieces.push(vec![start, end]),
                    }
                    going_on = end == to;
                }
                None => going_on = false,
            }
            from = to;
        }
        pieces
    }

    /// The part of a segment within (Liang and Barsky 1984).
    fn cut(&self, from: [f64; 2], to: [f64; 2]) -> Option<[[f64; 2]; 2]> {
        let (mut enter, mut leave) = (0.0f64, 1.0f64);
        for k in 0..2 {
            let (start, along) = (from[k] - self.center[k], to[k] - from[k]);
            if along == 0.0 {
                if start.abs() > self.half {
                    return None;
                }
                continue;
            }
            let [a, b] = [-self.half, self.half].map(|border| (border - start) / along);
            enter = enter.max(a.min(b));
            leave = leave.min(a.max(b));
        }
        let at = |t: f64| [0, 1].map(|k| from[k] + t * (to[k] - from[k]));
        // The ends are kept as they are, so that pieces join.
        let start = if enter == 0.0 { from } else { at(enter) };
        let end = if leave == 1.0 { to } else { at(leave) };
        (enter < leave).then_some([start, end])
    }
}

#[cfg(test)]
mod tests {
    use super::Window;

    #[test]
    fn a_loop_around_a_window_is_cut_where_it_leaves() {
        let window = Window { center: [0.0, 0.0], half: 1.0 };
        let loops = [[-3.0, 0.0], [0.5, 0.0], [0.5, 3.0]];
        assert_eq!(window.pieces(&loops, false), [vec![[-1.0, 0.0], [0.5, 0.0], [0.5, 1.0]]]);
        assert_eq!(window.pieces(&[[0.0, 0.0], [0.5, 0.5]], true).len(), 1);
        assert!(window.pieces(&[[3.0, 3.0], [3.0, -3.0]], true).is_empty());
        assert!(window.holds([1.0, -1.0]) && !window.holds([1.5, 0.0]));
    }
}
