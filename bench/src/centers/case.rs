//! The list of cases: which inputs, and what has to be reached.

use super::*;

/// The radii that cases name are known to so many digits.
pub(super) const KNOWN_RADIUS_TOLERANCE: f64 = 1e-6;
/// Rounding in a factor, which a maximum may meet exactly.
const FACTOR_ROUNDING: f64 = 1e-9;

pub(super) const CORE_SET: Quantity = Quantity::new("rows in the certificate", Unit::Plain);
pub(super) const CHECK: Quantity = Quantity::new("time of the check", Unit::Seconds);
pub(super) const DIFFERS: Quantity =
    Quantity::new("relative difference of radii to the peer's", Unit::Power);
/// Whole passes, one for each center, would take this share of the time when nothing but memory bound them.
pub(super) const BANDWIDTH: Quantity =
    Quantity::new("share of the bandwidth bound, a plain read for each center", Unit::Times);
pub(super) const FACTOR: Quantity =
    Quantity::new("radius over lower bound, over the factor stated", Unit::Times);

/// Points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Set {
    /// The cities of a file of `$TAUT_DATA/ball`.
    Cities(&'static str),
    /// So many normal points of space.
    Normal(usize),
}

/// The cities of Germany.
pub(super) const GERMANY: Set = Set::Cities("d15112.tsp.xz");
const USA: Set = Set::Cities("usa13509.xy.xz");
const SPACE: Set = Set::Normal(10_000);

/// So many centers, to such a gap, and what has to be reached.
#[derive(Clone, Copy)]
pub(super) struct Task {
    /// The points.
    pub(super) set: Set,
    /// Number of centers.
    pub(super) k: usize,
    /// Relative gap asked for.
    pub(super) epsilon: f64,
    /// Most permutations, where one takes minutes.
    pub(super) permutations: usize,
    /// The radius that is known.
    pub(super) radius: Option<f64>,
    /// What has to be reached, beside the gap and the radius.
    pub(super) must: &'static [Goal],
    /// What is hoped for.
    pub(super) aim: &'static [Goal],
}

const fn task(set: Set, k: usize, epsilon: f64) -> Task {
    Task { set, k, epsilon, permutations: usize::MAX, radius: None, must: &[], aim: &[] }
}

impl Task {
    const fn radius(self, radius: f64) -> Self {
        Task { radius: Some(radius), ..self }
    }

    const fn must(self, must: &'static [Goal]) -> Self {
        Task { must, ..self }
    }

    const fn aim(self, aim: &'static [Goal]) -> Self {
        Task { aim, ..self }
    }

    const fn once(self) -> Self {
        Task { permutations: 1, ..self }
    }
}

const GAP_EXACT: f64 = 1e-6;
const QUICK_AIM: &[Goal] = &[SECONDS.at_most(0.05)];
const CORE_SET_GOAL: Goal = CORE_SET.at_most(200.0);
const CHECK_GOAL: Goal = CHECK.at_most(1.0);
const PROVEN: &[Goal] = &[SECONDS.at_most(0.3), CORE_SET_GOAL, CHECK_GOAL];

const CITIES: &[Task] = &[
    task(GERMANY, 2, GAP_EXACT).radius(9342.60196519).must(PROVEN).aim(QUICK_AIM),
    task(GERMANY, 3, GAP_EXACT).radius(8139.66296907).must(PROVEN).aim(QUICK_AIM),
    task(GERMANY, 4, GAP_EXACT).radius(6573.74826488).must(PROVEN).aim(QUICK_AIM),
    task(GERMANY, 5, GAP_EXACT).radius(5818.46791619).must(PROVEN).aim(QUICK_AIM),
    task(GERMANY, 8, GAP_EXACT)
        .radius(4306.44830458)
        .must(&[SECONDS.at_most(0.1), CORE_SET_GOAL, CHECK_GOAL])
        .aim(QUICK_AIM),
    task(GERMANY, 10, GAP_EXACT).radius(3725.69052411).must(&[SECONDS.at_most(0.1)]).aim(QUICK_AIM),
    task(GERMANY, 12, GAP_EXACT).must(&[SECONDS.at_most(0.5)]).aim(&[SECONDS.at_most(0.3)]),
    task(USA, 5, GAP_EXACT).radius(99986.80259875).must(&[
        SECONDS.at_most(0.2),
        CORE_SET_GOAL,
        CHECK_GOAL,
    ]),
    task(USA, 10, GAP_EXACT).radius(65210.68259879).must(&[SECONDS.at_most(4.0)]),
];

const CITIES_15: &[Task] = &[
    task(GERMANY, 15, 0.01).must(&[SECONDS.at_most(1.2)]).aim(&[SECONDS.at_most(0.6)]),
    task(USA, 15, 0.01).must(&[SECONDS.at_most(100.0)]).aim(&[SECONDS.at_most(4.0)]),
];

const SPACE_TASKS: &[Task] = &[
    task(SPACE, 4, 0.01).must(&[SECONDS.at_most(0.1), CORE_SET_GOAL]).aim(&[SECONDS.at_most(0.01)]),
    task(SPACE, 6, 0.01).must(&[SECONDS.at_most(0.3), CORE_SET_GOAL]).aim(&[SECONDS.at_most(0.03)]),
    task(SPACE, 8, 0.01).must(&[SECONDS.at_most(0.3), CORE_SET_GOAL]).aim(&[SECONDS.at_most(0.1)]),
    task(SPACE, 10, 0.01).must(&[SECONDS.at_most(2.0)]).aim(&[SECONDS.at_most(1.0)]),
];

const CITIES_20: &[Task] = &[
    task(GERMANY, 20, 0.05).must(&[SECONDS.at_most(10.0)]).once(),
    task(GERMANY, 20, 0.01).must(&[SECONDS.at_most(120.0)]).aim(&[SECONDS.at_most(60.0)]).once(),
];

/// All sections; the longest is the last.
pub(crate) const AREA: Area<Run> = Area {
    name: "centers",
    runs: 5,
    threads: &[1, 2],
    limit: 120,
    peer_budget: 600,
    sections: &[
        runs("cities", |run, out| free::run(run, out, CITIES)).about(
            "Cities of Germany and of the USA, free centers at ε = 1e-6, beside the \
                 optima that are known.",
        ),
        runs("cities-15", |run, out| free::run(run, out, CITIES_15))
            .about("The same for k = 15, at 1 %."),
        runs("space", |run, out| free::run(run, out, SPACE_TASKS)).about(
            "Normal, 10⁴ × 3, free centers at 1 %; of the thesis some sets in space ran for almost a week, \
                 beside many other processes (2.5).",
        ),
        runs("discrete", discrete::run)
            .about(
                "Centers among the points, exact: 200 small sets beside set-cover programs \
                 under HiGHS, and the cities of Germany.",
            )
            .must(&[GAP.at_most(1e-11), DIFFERS.at_most(1e-12)]),
        runs("farthest-first", traversal::run)
            .about(
                "1000 points in farthest-first order, of 10⁷ × 3 in double and 10⁶ × 128 in \
                 single precision, beside NumPy.",
            )
            .must(&[BANDWIDTH.at_least(0.8), DIFFERS.at_most(1e-5)]),
        runs("outliers", outliers::run)
            .about("Uniform, 2000 × 2, without up to five points, at ε = 1e-6.")
            .must(&[GAP.at_most(GAP_EXACT)]),
        runs("streams", streams::run)
            .about(
                "Normal, 10⁶ × 3, one after another: the factor measured beside the one \
                 stated, on two orders.",
            )
            .must(&[FACTOR.at_most(1.0 + FACTOR_ROUNDING)]),
        runs("trees", trees::run)
            .about(
                "The nearest rows of 10⁵ places beside kiddo, and touching pairs of balls beside \
                 parry3d, on one thread.",
            ),
        runs("cities-20", |run, out| free::run(run, out, CITIES_20)).about(
            "The cities of Germany for k = 20, at 5 % and at 1 %: minutes, one permutation.",
        ),
    ],
};

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [&[Task]; 4] = [CITIES, CITIES_15, SPACE_TASKS, CITIES_20];

    #[test]
    fn names_are_unique_and_every_case_has_a_goal() {
        for section in AREA.sections {
            let is_free = ["cities", "space"].iter().any(|name| section.name.starts_with(name));
            // Trees judge ratios to peers by themselves.
            let is_judged = is_free || section.name == "trees";
            assert!(is_judged || !section.must.is_empty(), "{}", section.name);
        }
        assert!(ALL.concat().iter().all(|task| !task.must.is_empty() || !task.aim.is_empty()));
    }

    #[test]
    fn more_centers_of_a_set_are_known_to_reach_less_far() {
        for tasks in ALL {
            for pair in tasks.windows(2).filter(|pair| pair[0].set == pair[1].set) {
                assert!(pair[0].k < pair[1].k || pair[0].epsilon > pair[1].epsilon);
                let radii = pair[0].radius.zip(pair[1].radius);
                assert!(radii.is_none_or(|(a, b)| a > b), "k = {}", pair[1].k);
            }
        }
    }
}
