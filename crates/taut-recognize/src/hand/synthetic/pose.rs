//! How a hand lies on the page: stretch, pressure, rotation and shift, and the parts that follow from them.

use super::person::Person;
use super::random::{Stream, turn};
use super::shape::{Body, Part, Strip};
use super::{Defect, DefectKind, FingerName, Side};

/// The page of a scanner in inches.
const PAGE_INCHES: [f64; 2] = [8.5, 11.7];

/// The joint of a finger is so far below its web, in mm.
pub(super) const KNUCKLE_MM: f64 = 22.0;

/// How far above its base a web fills the corner between two fingers, in mm.
const WEB_END_MM: f64 = 4.0;

/// How far the wrist is from the middle of the page, so that thumb and little finger are as far from its sides, in mm.
const THUMB_SHIFT_MM: f64 = 18.0;

/// The page in pixels, and how the frame of a hand lies on it.
#[derive(Clone, Debug)]
pub(super) struct Page {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) pixels_per_mm: f64,
    pub(super) dots_per_inch: f64,
    /// 1 if the thumb is on the left of the page, −1 if on the right.
    mirror: f64,
}

impl Page {
    pub(super) fn new(side: Side, dots_per_inch: f64) -> Self {
        let [width, height] = PAGE_INCHES.map(|inches| (inches * dots_per_inch) as usize);
        // The palm of a right hand has the thumb on the right of one who looks at it.
        let mirror = if side == Side::Left { 1.0 } else { -1.0 };
        Self { width, height, pixels_per_mm: dots_per_inch / 25.4, dots_per_inch, mirror }
    }

    fn size_mm(&self) -> [f64; 2] {
        [self.width as f64 / self.pixels_per_mm, self.height as f64 / self.pixels_per_mm]
    }
}

/// How a hand lies on the page.
#[derive(Clone, Debug)]
pub(super) struct Pose {
    /// Directions of the five fingers in degrees, clockwise from the axis of the palm.
    directions: [f64; 5],
    lengths: [f64; 5],
    breadths: [f64; 5],
    bends: [[f64; 2]; 5],
    palm_breadth: f64,
    /// Sine and cosine of the rotation of the hand.
    rotation: [f64; 2],
    /// The place of the wrist from the middle of the lower edge, in mm to the right and up.
    wrist: [f64; 2],
}

impl Pose {
    /// Draws a pose; a hard one has any stretch.
    pub(super) fn draw(person: &Person, page: &Page, is_hard: bool, random: &mut Stream) -> Self {
        let stretch = if is_hard { random.between(0.25, 1.0) } else { random.between(0.45, 0.9) };
        // Thumbs vary less: lengths and areas of thumb and index finger hang on it, and real ones repeat within 0.36 of
        // the spread between people.
        let thumb_stretch = 0.75 + 0.3 * (stretch - 0.675);
        let angle = |k: usize, stretch: f64, random: &mut Stream| {
            person.angles[k] * stretch * (1.0 + 0.07 * random.normal())
        };
        let angles: [f64; 4] = [
            person.angles[0] * thumb_stretch * (1.0 + 0.03 * random.normal()),
            angle(1, stretch, random),
            angle(2, stretch, random),
            angle(3, stretch, random),
        ];
        let middle = 2.0 * random.normal();
        let index = middle - angles[1];
        let ring = middle + angles[2];
        let pressure = 1.0 + 0.010 * random.normal();
        let lengths = person.lengths.map(|length| {
            let [_, foreshortening] = turn(4.0 * random.normal().abs());
            length * foreshortening * (1.0 + 0.004 * random.normal())
        });
        let breadths =
            person.breadths.map(|breadth| breadth * pressure * (1.0 + 0.008 * random.normal()));
        let bends = person.bends.map(|bends| bends.map(|bend| bend + 0.8 * random.normal()));
        Self {
            directions: [index - angles[0], index, middle, ring, ring + angles[3]],
            lengths,
            breadths,
            bends,
            palm_breadth: person.body[2] * (1.0 + 0.3 * (pressure - 1.0) + 0.01 * (stretch - 0.65)),
            rotation: turn(6.0 * random.normal()),
            wrist: [
                // A hand with its thumb is in the middle of the page.
                page.mirror * THUMB_SHIFT_MM + (9.0 * random.normal()).clamp(-14.0, 14.0),
                55.0 + (12.0 * random.normal()).clamp(-30.0, 24.0),
            ],
        }
    }

    /// Applies what a defect changes of the pose, and returns the defect.
    pub(super) fn damage(&mut self, kind: DefectKind, page: &Page, random: &mut Stream) -> Defect {
        let finger = FingerName::ALL[random.below(5)];
        let first = FingerName::ALL[1 + random.below(3)];
        match kind {
            DefectKind::Shifted => {
                let sign = if random.share() < 0.5 { -1.0 } else { 1.0 };
                self.wrist[0] += sign * random.between(35.0, 60.0);
                Defect::Shifted
            }
            DefectKind::Lifted => Defect::Lifted(finger),
            DefectKind::Ring => {
                let b = [-1.0, 30.0, 0.5][random.below(3)];
                let pixels = random.between(2.0, 15.0) * page.dots_per_inch / 90.0;
                Defect::Ring { finger, pixels, b }
            }
            DefectKind::Bandage => {
                let b = [2.0 + 3.0 * random.normal(), 18.0, -25.0][random.below(3)];
                Defect::Bandage { finger, thickness: random.between(0.4, 1.2), b }
            }
            DefectKind::Joined => {
                // From the web on, or the tips only.
                let range = if random.share() < 0.7 {
                    [-0.1, random.between(0.12, 0.9)]
                } else {
                    [random.between(0.3, 0.7), 0.95]
                };
                Defect::Joined { first, range }
            }
            DefectKind::Adducted => {
                let gap = random.between(-5.0, 0.0);
                let k = first as usize;
                let shift = self.directions[k + 1] - self.directions[k] - gap;
                for direction in &mut self.directions[k + 1..] {
                    *direction -= shift;
                }
                Defect::Adducted { first, is_touching: true }
            }
        }
    }

    /// Returns the point of the hand's frame at a point of the page in pixels.
    pub(super) fn to_hand(&self, page: &Page, p: [f64; 2]) -> [f64; 2] {
        let [sine, cosine] = self.rotation;
        let size = page.size_mm();
        let x = p[0] / page.pixels_per_mm - 0.5 * size[0] - self.wrist[0];
        let y = size[1] - p[1] / page.pixels_per_mm - self.wrist[1];
        [page.mirror * (cosine * x - sine * y), sine * x + cosine * y]
    }

    /// Returns the point of the page in pixels at a point of the hand's frame.
    pub(super) fn to_page(&self, page: &Page, p: [f64; 2]) -> [f64; 2] {
        let [sine, cosine] = self.rotation;
        let size = page.size_mm();
        let (u, v) = (page.mirror * p[0], p[1]);
        let (x, y) = (cosine * u + sine * v, cosine * v - sine * u);
        let left = 0.5 * size[0] + self.wrist[0] + x;
        [left * page.pixels_per_mm, (size[1] - self.wrist[1] - y) * page.pixels_per_mm]
    }

    /// Returns the strips of the five fingers; that of the thumb is its last two bones.
    pub(super) fn strips(&self, person: &Person) -> [Strip; 5] {
        std::array::from_fn(|k| if k == 0 { self.thumb(person) } else { self.finger(person, k) })
    }

    fn finger(&self, person: &Person, k: usize) -> Strip {
        let (length, half) = (self.lengths[k], 0.5 * self.breadths[k]);
        let base =
            [person.base_x[k - 1] * self.palm_breadth, person.base_y[k - 1] * person.body[1]];
        let [sine, cosine] = turn((k as f64 - 2.2) * 4.0);
        let pivot = [base[0] - KNUCKLE_MM * sine, base[1] - KNUCKLE_MM * cosine];
        let [sine, cosine] = turn(self.directions[k]);
        let end = KNUCKLE_MM + length - half * person.tip[k];
        let at = |share: f64| KNUCKLE_MM + share * length;
        let widths = [
            [at(0.0), 1.10 * half],
            [at(0.18), half],
            [at(person.joint[k]), half],
            [at(0.56), person.waist[k] * half],
            [at(0.72), person.knuckle[k] * half],
            [end, person.tip[k] * half],
        ];
        let bends = [[at(person.joint[k]), self.bends[k][0]], [at(0.70), self.bends[k][1]]];
        let bends = bends.map(|[place, degrees]| [place, slope(degrees)]);
        Strip::new(pivot, [sine, cosine], [0.0, end], &widths, bends.to_vec())
    }

    /// Returns the joint of the thumb at the end of its metacarpal bone.
    fn thumb_joint(&self, person: &Person) -> [[f64; 2]; 2] {
        let root =
            [person.thumb_root[0] * self.palm_breadth, person.thumb_root[1] * person.body[1]];
        let [sine, cosine] = turn(0.75 * self.directions[0] - 5.7);
        [root, [root[0] + person.metacarpal * sine, root[1] + person.metacarpal * cosine]]
    }

    fn thumb(&self, person: &Person) -> Strip {
        let half = 0.5 * self.breadths[0];
        let [_, joint] = self.thumb_joint(person);
        let length = self.lengths[0];
        let end = length - 0.72 * half;
        let widths = [
            [0.0, 1.08 * half],
            [0.25 * end, 0.95 * half],
            [0.45 * end, half],
            [0.75 * end, 0.93 * half],
            [end, 0.72 * half],
        ];
        let bends = vec![[0.45 * end, slope(2.0 * self.bends[0][0])]];
        let [sine, cosine] = turn(self.directions[0]);
        Strip::new(joint, [sine, cosine], [0.0, end], &widths, bends)
    }

    /// Returns the parts of the hand with their strips.
    pub(super) fn body(&self, person: &Person, strips: &[Strip; 5]) -> Body {
        let (hb, pl) = (self.palm_breadth, person.body[1]);
        let wrist = person.body[3] / 2.9;
        let palm =
            [[-0.40, 0.84], [-0.14, 0.89], [0.12, 0.87], [0.36, 0.77], [0.40, 0.55], [0.36, 0.20]];
        let mut corners: Vec<_> = palm.iter().map(|[x, y]| [x * hb, y * pl]).collect();
        corners.extend([[0.42 * wrist, -5.0], [-0.42 * wrist, -5.0]]);
        corners.extend([[-0.36 * hb, 0.25 * pl], [-0.42 * hb, 0.6 * pl]]);
        let arm = [
            [-0.5 * wrist, 10.0],
            [0.5 * wrist, 10.0],
            [0.525 * wrist, -200.0],
            [-0.525 * wrist, -200.0],
        ];
        let mut parts = vec![
            (Part::Polygon(corners, 0.09 * hb), 0.0),
            (Part::Polygon(arm.to_vec(), 0.0), 10.0),
        ];
        // A web reaches from the joints of two fingers to a little below their level.
        const WEB_MM: f64 = KNUCKLE_MM - 1.5;
        for k in 1..4 {
            let corner = |k: usize, t: f64| strips[k].point(t, 0.0);
            let web =
                vec![corner(k, 0.0), corner(k, WEB_MM), corner(k + 1, WEB_MM), corner(k + 1, 0.0)];
            parts.push((Part::Polygon(web, 0.0), 0.5));
        }
        let [root, joint] = self.thumb_joint(person);
        let web = vec![root, joint, strips[1].point(6.0, 0.0), strips[1].point(0.0, 0.0)];
        parts.push((Part::Polygon(web, 0.0), 0.5));
        let bone = [joint[0] - root[0], joint[1] - root[1]];
        let bone = bone.map(|v| v / person.metacarpal);
        let thick = person.ball;
        let widths = [
            [0.0, 1.45 * thick],
            [0.5 * person.metacarpal, 1.25 * thick],
            [person.metacarpal, 0.56 * self.breadths[0]],
        ];
        let range = [0.0, person.metacarpal];
        parts.push((Part::Strip(Strip::new(root, bone, range, &widths, vec![])), 4.0));
        parts.push((Part::Strip(strips[0].clone()), 4.0));
        parts.extend(strips[1..].iter().map(|strip| (Part::Strip(strip.clone()), person.web)));
        Body { parts, web_end: KNUCKLE_MM + WEB_END_MM }
    }
}

/// Returns the slope of an angle in degrees.
fn slope(degrees: f64) -> f64 {
    let [sine, cosine] = turn(degrees);
    sine / cosine
}
