//! Synthetic scans of hands with ground truth: people by published statistics, and what goes wrong in practice.
//!
//! *Idea.* A hand is the zero of a function of the plane: strips of changing width for the fingers, polygons for palm
//! and webs, rounded where they join. Its outline, tips and valleys are known before pixels, colors and noise.
//! *Guarantee.* A scan is a function of seed, person and scan alone: scans can be made in any order and on any machine,
//! with the same bytes.
//! *Limits.* The colors and the noise are design values. Figures on synthetic scans say how robust the extraction is;
//! they are no error rates of people.

mod paint;
mod person;
mod pose;
mod random;
mod shape;
mod truth;

use super::failure::FingerName;
use super::mask::Mask;
use super::read::RgbImage;
use super::{FEATURES, Side};
pub use person::{ANSUR, ANSUR_CORRELATIONS, FINGER_LENGTHS, Person};
use pose::Pose;
use random::Stream;

/// Purposes of random numbers: each has its own sequence.
mod purpose {
    pub(super) const PERSON: u64 = 0;
    pub(super) const POSE: u64 = 1;
    pub(super) const DEFECT: u64 = 2;
    pub(super) const PAINT: u64 = 3;
}

/// How to make scans.
#[derive(Clone, Debug, PartialEq)]
pub struct Generator {
    /// The seed of the set. Default 0.
    pub seed: u64,
    /// The hand, whose palm faces the sensor. Default: the right one, as in the thesis.
    pub side: Side,
    /// Dots per inch of the page of 8.5 × 11.7 inches. Range 40 to 600, default 90.
    pub dots_per_inch: f64,
    /// How often each defect happens. Default: as the thesis' data are described.
    pub rates: Rates,
}

/// How often a scan has each defect; at most one happens to a scan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rates {
    /// The hand is shifted sideways by 35 to 60 mm. Default 0.03.
    pub cut_off: f64,
    /// The last third of a finger is not on the glass. Default 0.02.
    pub lifted: f64,
    /// A finger has a ring. Default 0.03.
    pub ring: f64,
    /// A finger has a bandage. Default 0.
    pub bandage: f64,
    /// Two fingers are joined. Default 0.
    pub fused: f64,
    /// A sleeve covers the wrist, beside any other defect. Default 0.2.
    pub sleeve: f64,
}

impl Default for Rates {
    fn default() -> Self {
        Self { cut_off: 0.03, lifted: 0.02, ring: 0.03, bandage: 0.0, fused: 0.0, sleeve: 0.2 }
    }
}

impl Default for Generator {
    fn default() -> Self {
        Self { seed: 0, side: Side::Right, dots_per_inch: 90.0, rates: Rates::default() }
    }
}

/// What is wrong with a scan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Defect {
    /// The hand was shifted toward a side of the page; [`Truth::is_cut_off`] says whether it is beyond it.
    Shifted,
    /// The last third of a finger is not on the glass.
    Lifted(FingerName),
    /// A finger has a ring.
    Ring {
        /// The finger.
        finger: FingerName,
        /// The length of the ring along the finger in pixels.
        pixels: f64,
        /// Its b*.
        b: f64,
    },
    /// A finger has a bandage.
    Bandage {
        /// The finger.
        finger: FingerName,
        /// How much it adds to the width on each side, in mm.
        thickness: f64,
        /// Its b*.
        b: f64,
    },
    /// A patch of the color of skin joins a finger to the next one.
    Joined {
        /// The finger nearer to the thumb.
        first: FingerName,
        /// Where the patch begins and ends, as shares of the finger's length.
        range: [f64; 2],
    },
    /// A finger lies against the next one.
    Adducted {
        /// The finger nearer to the thumb.
        first: FingerName,
        /// Whether they touch above their web.
        is_touching: bool,
    },
}

/// What is known of a scan before pixels and noise.
#[derive(Clone, Debug)]
pub struct Truth {
    /// The hand.
    pub side: Side,
    /// The pixels whose centers are in the hand.
    pub mask: Mask,
    /// Where the axes of the fingers meet the outline, thumb first, in pixels.
    pub tips: [[f64; 2]; 5],
    /// The middles of the lowest parts between neighboring fingers along the bisector of their axes, in pixels.
    pub valleys: [[f64; 2]; 4],
    /// The thirty features of the outline before pixels, with the true tips and valleys; without the defect, if there
    /// is one. `None` for hands that are cut off, whose outline is not on the page.
    pub features: Option<[f64; FEATURES]>,
    /// Whether a part of the hand above the wrist is beyond the page.
    pub is_cut_off: bool,
    /// What is wrong.
    pub defect: Option<Defect>,
    /// Whether a sleeve covers the wrist.
    pub has_sleeve: bool,
}

/// A synthetic scan.
#[derive(Clone, Debug)]
pub struct Scan {
    /// The image.
    pub image: RgbImage,
    /// What it shows.
    pub truth: Truth,
}

/// A defect that is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DefectKind {
    /// See [`Defect::Shifted`].
    Shifted,
    /// See [`Defect::Lifted`].
    Lifted,
    /// See [`Defect::Ring`].
    Ring,
    /// See [`Defect::Bandage`].
    Bandage,
    /// See [`Defect::Joined`].
    Joined,
    /// See [`Defect::Adducted`].
    Adducted,
}

impl Generator {
    /// Returns the person of a number.
    #[must_use]
    pub fn person(&self, person: u64) -> Person {
        Person::draw(Stream::new([self.seed, person, 0, purpose::PERSON]))
    }

    /// Makes a scan of a person; defects happen at the generator's rates.
    #[must_use]
    pub fn scan(&self, person: u64, scan: u64) -> Scan {
        let mut random = self.stream(person, scan, purpose::DEFECT);
        let share = random.share();
        let rates = &self.rates;
        let kinds = [
            (rates.cut_off, DefectKind::Shifted),
            (rates.lifted, DefectKind::Lifted),
            (rates.ring, DefectKind::Ring),
            (rates.bandage, DefectKind::Bandage),
            (0.5 * rates.fused, DefectKind::Joined),
            (0.5 * rates.fused, DefectKind::Adducted),
        ];
        let mut sum = 0.0;
        let kind = kinds.iter().find(|(rate, _)| {
            sum += rate;
            share < sum
        });
        self.make(person, scan, kind.map(|&(_, kind)| kind), random)
    }

    /// Makes a scan of a person with a defect, or with none.
    #[must_use]
    pub fn scan_with(&self, person: u64, scan: u64, kind: Option<DefectKind>) -> Scan {
        let mut random = self.stream(person, scan, purpose::DEFECT);
        random.share();
        self.make(person, scan, kind, random)
    }

    fn stream(&self, person: u64, scan: u64, purpose: u64) -> Stream {
        Stream::new([self.seed, person, scan.wrapping_add(1), purpose])
    }

    fn make(&self, person: u64, scan: u64, kind: Option<DefectKind>, mut random: Stream) -> Scan {
        let owner = self.person(person);
        // Every fifth scan is one of those that were made difficult on purpose (thesis, 7.3).
        let is_hard = scan % 5 == 4;
        let page = pose::Page::new(self.side, self.dots_per_inch.clamp(40.0, 600.0));
        let mut pose =
            Pose::draw(&owner, &page, is_hard, &mut self.stream(person, scan, purpose::POSE));
        let has_sleeve = random.share() < self.rates.sleeve;
        let free = pose.clone();
        let mut defect = kind.map(|kind| pose.damage(kind, &page, &mut random));
        // Shifting moves the hand itself; for all other defects the truth is the free hand.
        let honest = if kind == Some(DefectKind::Shifted) { &pose } else { &free };
        let mut outline = truth::Outlined::new(honest, &owner, &page);
        let mut lying = outline.clone();
        if let Some(Defect::Adducted { first, is_touching }) = &mut defect {
            lying = truth::Outlined::new(&pose, &owner, &page);
            *is_touching = lying.is_touching(*first as usize);
            // Fingers that only lie close have their own truth.
            if !*is_touching {
                outline = lying.clone();
            }
        }
        let paint = self.stream(person, scan, purpose::PAINT);
        let image = paint::paint(&lying, &owner, &page, defect, has_sleeve, random, paint);
        Scan { image, truth: outline.into_truth(self.side, defect, has_sleeve) }
    }
}
