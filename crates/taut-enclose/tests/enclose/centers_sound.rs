//! Answers of centers that are damaged, and what is asked of the checker: it refuses them, or what they claim is so.
//!
//! The problem that a damaged certificate states is solved again, to tell whether its claim is so.

use taut_certify::{Centers, CheckError, LowerBound, Solution};
use taut_enclose::{CentersOptions, centers};
use taut_points::{Monitor, Points, hash_points};

/// An answer that is right, or was before it was damaged, and its rows.
#[derive(Clone)]
pub(crate) struct Sound {
    pub(crate) name: &'static str,
    pub(crate) values: Vec<f64>,
    pub(crate) columns: usize,
    pub(crate) found: Solution<Centers>,
}

impl Sound {
    /// The answer about these rows, which the checker accepts.
    pub(crate) fn of(
        name: &'static str,
        values: Vec<f64>,
        columns: usize,
        k: usize,
        options: &CentersOptions<'_>,
    ) -> Self {
        let found = centers(&Points::new(&values, columns).unwrap(), k, options).unwrap();
        let sound = Sound { name, values, columns, found };
        sound.check().unwrap_or_else(|why| panic!("{name}: {why}"));
        sound
    }

    pub(crate) fn rows(&self) -> usize {
        self.values.len() / self.columns
    }

    fn points(&self) -> Points<'_, f64> {
        Points::new(&self.values, self.columns).unwrap()
    }

    fn check(&self) -> Result<(), CheckError> {
        self.found.check(&self.points()).map(|_| ())
    }

    /// Makes the hash that of the rows, so that it hides nothing.
    pub(crate) fn rehash(&mut self) {
        let hash = hash_points(&self.points(), &Monitor::silent()).unwrap();
        self.found.certificate.points_hash = hash;
    }

    /// The least radius of what the certificate says was asked: a lower and an upper bound.
    fn optimum(&self) -> Option<(f64, f64)> {
        let certificate = &self.found.certificate;
        let options = CentersOptions {
            epsilon: 1e-9,
            inputs: certificate.items,
            placement: certificate.placement,
            outliers: certificate.outliers,
            group: certificate.group.map(|column| column as usize),
            ..Default::default()
        };
        let points = self.points();
        let found = centers(&points, certificate.k as usize, &options).ok()?;
        found.check(&points).unwrap_or_else(|why| panic!("{why}\n{:?}\n{found:?}", self.values));
        Some((found.answer.lower_bound, found.answer.radius))
    }

    /// Fails where the checker accepts what is not so.
    pub(crate) fn is_judged(&self, damage: &str) {
        if self.check().is_err() {
            return;
        }
        let Some((least, reached)) = self.optimum() else {
            panic!("{}: accepted, though nothing can be so: {damage}", self.name);
        };
        let Centers { radius, lower_bound, .. } = self.found.answer;
        assert!(
            radius >= least && lower_bound <= reached && radius.is_finite(),
            "{}: accepted: {damage}: {lower_bound} to {radius}, found {least} to {reached}",
            self.name
        );
    }

    /// Fails where the checker accepts.
    pub(crate) fn is_refused(&self, damage: &str) {
        assert!(self.check().is_err(), "{}: accepted: {damage}", self.name);
    }

    /// The answer after a change.
    pub(crate) fn with(&self, change: impl FnOnce(&mut Sound)) -> Sound {
        let mut damaged = self.clone();
        change(&mut damaged);
        damaged
    }

    /// The answer after one change for each value.
    pub(crate) fn each<T>(
        &self,
        values: impl IntoIterator<Item = T>,
        change: impl Fn(&mut Sound, T),
    ) -> Vec<Sound> {
        values.into_iter().map(|value| self.with(|damaged| change(damaged, value))).collect()
    }
}

/// Fails unless both kinds of proof are among the answers.
pub(crate) fn have_both_proofs(sound: &[Sound]) {
    let is_apart = |s: &Sound| s.found.certificate.proof == LowerBound::Separated;
    assert!(sound.iter().any(is_apart) && !sound.iter().all(is_apart));
}

/// Radius, bound, gap and centers in two dimensions, damaged.
pub(crate) fn numbers_are_judged(sound: &Sound) {
    let Centers { radius, lower_bound, .. } = sound.found.answer;
    let no_radii = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, -0.0, 1e308, 0.0];
    let less = [5e-324, f64::MIN_POSITIVE, radius * (1.0 - 1e-9), radius / 2.0];
    for damaged in
        sound.each(no_radii.into_iter().chain(less), |s, value| s.found.answer.radius = value)
    {
        damaged.is_refused("the radius");
    }
    let factors = [1.0 + 1e-7, 1.5, 1e6, 1e300].map(|factor| radius * factor);
    for damaged in
        sound.each(factors.into_iter().chain([5e-324, f64::MIN_POSITIVE, 0.0]), |s, value| {
            s.found.answer.lower_bound = value;
            s.found.answer.radius = value;
        })
    {
        damaged.is_refused("bound and radius");
    }
    for damaged in
        sound.each([f64::NAN, f64::INFINITY, -1.0, -0.0, radius * (1.0 + 1e-9)], |s, value| {
            s.found.answer.lower_bound = value;
        })
    {
        damaged.is_refused("the bound");
    }
    for damaged in sound.each([radius, 5e-324, lower_bound / 2.0, 0.0], |s, value| {
        s.found.answer.lower_bound = value;
        s.found.certificate.gap = f64::MAX;
    }) {
        damaged.is_judged("the bound, with any gap");
    }
    for damaged in
        sound.each([f64::NAN, -1.0, f64::INFINITY], |s, value| s.found.certificate.gap = value)
    {
        damaged.is_refused("the gap");
    }
    for center in 0..sound.found.answer.centers.len() {
        for column in 0..2 {
            let numbers = [f64::NAN, f64::INFINITY, 1e308, 1e300, 5e-324, 0.0];
            for damaged in
                sound.each(numbers, |s, value| s.found.answer.centers[center][column] = value)
            {
                damaged.is_judged("a coordinate of a center");
            }
        }
    }
}

/// Other numbers of centers and of outliers than were asked for.
pub(crate) fn counts_are_judged(sound: &Sound) {
    for damaged in sound.each(1..8, |s, k| s.found.certificate.k = k) {
        damaged.is_judged("another k");
    }
    for damaged in sound.each(0..4, |s, z| s.found.certificate.outliers = z) {
        damaged.is_judged("other outliers");
    }
}

/// The log of a search, damaged, or put in the place of the other proof.
pub(crate) fn branches_are_judged(sound: &Sound) {
    let core = sound.found.certificate.core_set.len();
    let LowerBound::Branches { items } = &sound.found.certificate.proof else {
        if sound.found.answer.lower_bound > 0.0 {
            let no_log = LowerBound::Branches { items: vec![] };
            sound.with(|s| s.found.certificate.proof = no_log).is_refused("no log");
        }
        return;
    };
    for at in 0..items.len() {
        let with = |change: &dyn Fn(&mut Vec<u32>)| {
            sound.with(|s| {
                if let LowerBound::Branches { items } = &mut s.found.certificate.proof {
                    change(items);
                }
            })
        };
        with(&|items| items.truncate(at)).is_refused("a log cut off");
        with(&|items| items.insert(at, items[at])).is_judged("a branch repeated");
        with(&|items| items.push(items[at])).is_refused("a branch added");
        with(&|items| items[at] = u32::MAX).is_refused("no such item");
        with(&|items| items[at] = (items[at] + 1) % core as u32).is_judged("another item");
        with(&|items| {
            items.remove(at);
        })
        .is_judged("a branch dropped");
    }
    sound.with(|s| s.found.certificate.proof = LowerBound::Separated).is_judged("said to be apart");
}

/// Every other center for every row, and one that is not there.
pub(crate) fn assignments_are_judged(sound: &Sound) {
    for row in 0..sound.rows() {
        let centers = sound.found.answer.centers.len() as u32;
        let others = (0..=centers).filter(|&c| c != sound.found.answer.assignment[row]);
        for damaged in sound.each(others, |s, center| s.found.answer.assignment[row] = center) {
            damaged.is_refused("another center");
        }
    }
    let less = sound.found.answer.assignment.len() - 1;
    sound.with(|s| s.found.answer.assignment.truncate(less)).is_refused("an assignment cut off");
}
