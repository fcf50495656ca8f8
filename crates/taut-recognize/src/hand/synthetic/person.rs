//! A person of the synthetic set: the measures of a hand, drawn by published statistics.
//!
//! *Sources.* Hand length, palm length, hand breadth and wrist circumference with their correlations: ANSUR II, 4082 men
//! and 1986 women. Visible lengths of fingers and angles between them: Chatzioglou et al., Anat. Cell Biol. 57(2), 2024,
//! 51 hands. Breadths of fingers and the shape of the outline between these measures: design values.

use super::random::Stream;

/// Means and standard deviations in mm of hand length, palm length, hand breadth and wrist circumference.
pub const ANSUR: [[[f64; 2]; 4]; 2] = [
    [[193.28, 9.95], [116.46, 6.23], [88.26, 4.39], [175.92, 8.96]],
    [[181.08, 10.06], [108.70, 5.94], [78.15, 3.84], [154.79, 7.83]],
];

/// Their correlations by rows, for men and women.
pub const ANSUR_CORRELATIONS: [[[f64; 4]; 4]; 2] = [
    [
        [1.0, 0.795, 0.582, 0.545],
        [0.795, 1.0, 0.477, 0.469],
        [0.582, 0.477, 1.0, 0.713],
        [0.545, 0.469, 0.713, 1.0],
    ],
    [
        [1.0, 0.839, 0.570, 0.538],
        [0.839, 1.0, 0.498, 0.498],
        [0.570, 0.498, 1.0, 0.669],
        [0.538, 0.498, 0.669, 1.0],
    ],
];

/// Means and standard deviations in mm of the visible lengths of the fingers, thumb first.
pub const FINGER_LENGTHS: [[f64; 2]; 5] =
    [[49.5, 5.5], [63.9, 4.1], [70.7, 5.2], [65.5, 4.8], [53.3, 4.3]];

/// Means and standard deviations in mm of the breadths at the middle joint, at the thumb's joint.
const FINGER_BREADTHS: [[f64; 2]; 5] =
    [[21.5, 1.7], [18.6, 1.35], [18.7, 1.35], [17.4, 1.3], [15.6, 1.2]];

/// Means and standard deviations in degrees of the largest angles between neighboring fingers.
const FINGER_ANGLES: [[f64; 2]; 4] = [[53.4, 6.5], [17.2, 2.6], [14.3, 2.3], [32.1, 7.0]];

/// The share of men.
const MEN: f64 = 0.6;

/// The measures of a hand.
#[derive(Clone, Debug, PartialEq)]
pub struct Person {
    /// Whether the measures are drawn from those of men.
    pub is_male: bool,
    /// Hand length, palm length, hand breadth and wrist circumference in mm.
    pub body: [f64; 4],
    /// Visible lengths of the fingers in mm, thumb first.
    pub lengths: [f64; 5],
    /// Breadths at the middle joints in mm.
    pub breadths: [f64; 5],
    pub(super) angles: [f64; 4],
    pub(super) bends: [[f64; 2]; 5],
    pub(super) base_x: [f64; 4],
    pub(super) base_y: [f64; 4],
    pub(super) waist: [f64; 5],
    pub(super) knuckle: [f64; 5],
    pub(super) tip: [f64; 5],
    pub(super) joint: [f64; 5],
    pub(super) web: f64,
    pub(super) thumb_root: [f64; 2],
    pub(super) metacarpal: f64,
    pub(super) ball: f64,
    /// L*, a*, b* of the skin.
    pub(super) skin: [f64; 3],
}

impl Person {
    /// Draws a person.
    pub(super) fn draw(mut random: Stream) -> Self {
        let random = &mut random;
        let is_male = random.share() < MEN;
        let sex = usize::from(!is_male);
        let raw: [f64; 4] = std::array::from_fn(|_| random.normal());
        let factor = cholesky(&ANSUR_CORRELATIONS[sex]);
        let standard: [f64; 4] =
            std::array::from_fn(|i| (0..=i).map(|j| factor[i][j] * raw[j]).sum());
        let body = std::array::from_fn(|i| ANSUR[sex][i][0] + ANSUR[sex][i][1] * standard[i]);
        // Fingers follow what the hand is longer than its palm, and its breadth, beside their own part. Means and
        // deviations are those of both sexes together: 74.9 ± 6.2 and 84.2 ± 6.5 mm.
        let long = (body[0] - body[1] - 74.9) / 6.2;
        let broad = (body[2] - 84.2) / 6.5;
        let mut mixed = |table: &[[f64; 2]; 5], common: f64, share: f64| {
            let own = (1.0 - share * share).sqrt();
            table.map(|[mean, deviation]| {
                mean + deviation * (share * common + own * random.normal()).clamp(-3.5, 3.5)
            })
        };
        let lengths = mixed(&FINGER_LENGTHS, long, 0.85);
        let breadths = mixed(&FINGER_BREADTHS, broad, 0.8);
        let mut around = |mean: f64, deviation: f64| mean + deviation * random.normal();
        Self {
            is_male,
            body,
            lengths,
            breadths,
            angles: FINGER_ANGLES.map(|[mean, deviation]| around(mean, deviation)),
            bends: std::array::from_fn(|_| [around(0.0, 2.2), around(0.0, 2.2)]),
            base_x: [-0.365, -0.125, 0.125, 0.355].map(|x| around(x, 0.012)),
            base_y: [0.955, 1.0, 0.965, 0.865].map(|y| around(y, 0.012)),
            waist: std::array::from_fn(|_| around(0.93, 0.02)),
            knuckle: std::array::from_fn(|_| around(0.88, 0.025)),
            tip: std::array::from_fn(|_| around(0.78, 0.03)),
            joint: std::array::from_fn(|_| around(0.40, 0.015)),
            web: 2.2 + 0.5 * around(0.0, 1.0).abs(),
            thumb_root: [around(-0.30, 0.015), around(0.26, 0.015)],
            metacarpal: 44.0 * around(1.0, 0.06),
            ball: 13.5 * around(1.0, 0.07),
            skin: [
                60.0 + 5.0 * around(0.0, 1.0).clamp(-3.0, 3.0),
                around(13.0, 2.0),
                around(17.0, 2.0),
            ],
        }
    }
}

/// Returns the lower Cholesky factor of a correlation matrix.
fn cholesky(matrix: &[[f64; 4]; 4]) -> [[f64; 4]; 4] {
    let mut factor = [[0.0; 4]; 4];
    for i in 0..4 {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| factor[i][k] * factor[j][k]).sum();
            let rest: f64 = matrix[i][j] - sum;
            factor[i][j] = if i == j { rest.max(0.0).sqrt() } else { rest / factor[j][j] };
        }
    }
    factor
}
