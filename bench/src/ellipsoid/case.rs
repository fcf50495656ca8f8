//! The list of cases: which inputs, and what has to be reached.

use super::*;

/// Rounding in what is minimized, below which two answers are equally good.
const OBJECTIVE_ROUNDING: f64 = 1e-11;

pub(super) const OUTSIDE: Quantity =
    Quantity::new("log-volume outside the known bracket", Unit::Power);
/// By the clock, least over least.
pub(super) const FASTER: Quantity = Quantity::new("time of the peer over ours", Unit::Times);
pub(super) const OBJECTIVE: Quantity =
    Quantity::new("what is minimized, less what the peer reached", Unit::Power);
pub(super) const OTHER_FLAGS: Quantity =
    Quantity::new("sets with other flagged rows than published", Unit::Plain);
pub(super) const OTHER_THAN_PEER: Quantity =
    Quantity::new("sets with other rows weighed out than the peer's, for the same h", Unit::Plain);
/// Of radius or volume.
pub(super) const DIFFERS: Quantity = Quantity::new("relative difference to the peer", Unit::Power);

/// Points drawn after one law, once for each seed.
pub(super) struct Input {
    /// From what they are drawn.
    pub(super) law: Law,
    /// How many.
    pub(super) n: usize,
    /// Their dimension.
    pub(super) d: usize,
    /// How many seeds.
    pub(super) seeds: u64,
    /// What has to be reached, beside the goals of the case, by the slowest of the seeds.
    pub(super) must: &'static [Goal],
    /// What is hoped for.
    pub(super) aim: &'static [Goal],
}

const fn input(law: Law, n: usize, d: usize) -> Input {
    Input { law, n, d, seeds: 1, must: &[], aim: &[] }
}

impl Input {
    const fn seeds(self, seeds: u64) -> Self {
        Input { seeds, ..self }
    }

    const fn goals(self, must: &'static [Goal], aim: &'static [Goal]) -> Self {
        Input { must, aim, ..self }
    }
}

const SHELLS: [Law; 3] = [Law::Shell(1e-2), Law::Shell(1e-4), Law::Shell(1e-8)];
const SHELL_5_10: &[Goal] = &[SECONDS.at_most(0.09)];
const SHELL_5_10_AIM: &[Goal] = &[SECONDS.at_most(0.03)];
const SHELL_6_10: &[Goal] = &[SECONDS.at_most(0.5)];
const SHELL_4_30: &[Goal] = &[SECONDS.at_most(0.5)];
const SHELL_4_30_AIM: &[Goal] = &[SECONDS.at_most(0.3)];

const NORMAL: &[Input] = &[
    input(Law::Normal, 100_000, 10).goals(&[SECONDS.at_most(0.0035)], &[SECONDS.at_most(0.003)]),
    input(Law::Normal, 1_000_000, 10).goals(&[SECONDS.at_most(0.05)], &[SECONDS.at_most(0.015)]),
    input(Law::Normal, 100_000, 30).goals(&[SECONDS.at_most(0.09)], &[SECONDS.at_most(0.025)]),
    input(Law::Normal, 100_000, 50).goals(&[SECONDS.at_most(0.5)], &[SECONDS.at_most(0.12)]),
    input(Law::Normal, 10_000, 100).goals(&[SECONDS.at_most(0.32)], &[SECONDS.at_most(0.25)]),
];

const SHELL_INPUTS: &[Input] = &[
    input(SHELLS[0], 100_000, 10).seeds(5).goals(SHELL_5_10, SHELL_5_10_AIM),
    input(SHELLS[1], 100_000, 10).seeds(5).goals(SHELL_5_10, SHELL_5_10_AIM),
    input(SHELLS[2], 100_000, 10).seeds(5).goals(SHELL_5_10, SHELL_5_10_AIM),
    input(SHELLS[0], 1_000_000, 10).seeds(5).goals(SHELL_6_10, &[]),
    input(SHELLS[1], 1_000_000, 10).seeds(5).goals(SHELL_6_10, &[]),
    input(SHELLS[2], 1_000_000, 10).seeds(5).goals(SHELL_6_10, &[]),
    input(SHELLS[0], 10_000, 30).seeds(5).goals(SHELL_4_30, SHELL_4_30_AIM),
    input(SHELLS[1], 10_000, 30).seeds(5).goals(SHELL_4_30, SHELL_4_30_AIM),
    input(SHELLS[2], 10_000, 30).seeds(5).goals(SHELL_4_30, SHELL_4_30_AIM),
];

const TAILS: &[Input] = &[
    input(Law::Cauchy, 100_000, 10).seeds(5).goals(&[SECONDS.at_most(0.01)], &[]),
    input(SHELLS[0], 1_000_000, 3).seeds(5).goals(&[SECONDS.at_most(0.06)], &[]),
    input(SHELLS[1], 1_000_000, 3).seeds(5).goals(&[SECONDS.at_most(0.06)], &[]),
    input(SHELLS[2], 1_000_000, 3).seeds(5).goals(&[SECONDS.at_most(0.06)], &[]),
];

/// All sections; the longest is the last.
pub(crate) const AREA: Area<Run> = Area {
    name: "ellipsoid",
    runs: 9,
    threads: &[1, 2],
    limit: 120,
    peer_budget: 60,
    sections: &[
        runs("real", real::run)
            .about(
                "Thirty sets of real data at ε = 1e-12, beside the brackets in which their \
                 optima lie.",
            )
            .must(&[GAP.at_most(1e-12), OUTSIDE.at_most(1e-11), SECONDS.at_most(1.5e-3)])
            .aim(&[OUTSIDE.at_most(1e-12), SECONDS.at_most(0.6e-3)]),
        runs("normal", |run, out| points::run(run, out, NORMAL))
            .about("Normal points at ε = 1e-12.")
            .must(&[GAP.at_most(1e-12)]),
        runs("shells", |run, out| points::run(run, out, SHELL_INPUTS))
            .about(
                "Points near an ellipsoid with axes from 1 to 1000, at ε = 1e-12, five seeds each.",
            )
            .must(&[GAP.at_most(1e-12)]),
        runs("tails", |run, out| points::run(run, out, TAILS))
            .about("Cauchy points, and shells of space, at ε = 1e-12, five seeds each.")
            .must(&[GAP.at_most(1e-12)]),
        runs("plane", |run, out| {
            plane::run(run, out, &[Law::Normal, Law::Uniform, Law::Shell(1e-2), Law::Mix])
        })
        .about("A million points of the plane at ε = 1e-12, beside CGAL's Min_ellipse_2.")
        .must(&[GAP.at_most(1e-12), FASTER.at_least(8.0)])
        .aim(&[FASTER.at_least(20.0)]),
        runs("ellipsoids", shapes::run)
            .about(
                "A thousand ellipsoids in ten dimensions at ε = 1e-6: the smallest ellipsoid, \
                 the smallest ball.",
            )
            .must(&[GAP.at_most(1e-6), SECONDS.at_most(0.5)])
            .aim(&[SECONDS.at_most(0.1)]),
        runs("conic", conic::run)
            .about(
                "Small sets of points, and twenty ellipsoids, at ε = 1e-10, beside the conic \
                 solver Clarabel under cvxpy.",
            )
            .must(&[GAP.at_most(1e-9), DIFFERS.at_most(1e-6)]),
        runs("approximate", approximate::run)
            .about(
                "Normal points at ε = 1e-12, beside CGAL's Approximate_min_ellipsoid_d and \
                 dynesty's bounding ellipsoid.",
            )
            .must(&[GAP.at_most(1e-12)]),
        runs("mcd", |run, out| robust::run(run, out, Cloud::Wide))
            .about(
                "10⁵ points in ten dimensions, 30 % of them in one cloud far off: MCD beside \
                 scikit-learn, five seeds.",
            )
            .must(&[OBJECTIVE.at_most(OBJECTIVE_ROUNDING), FASTER.at_least(5.0)]),
        runs("mcd-tight", |run, out| robust::run(run, out, Cloud::Tight))
            .about(
                "The same with a cloud a tenth as wide, which h points of the least \
                 determinant take in.",
            )
            .must(&[OBJECTIVE.at_most(OBJECTIVE_ROUNDING), FASTER.at_least(5.0)]),
        runs("flags", robust::run_flags)
            .about(
                "The outliers of hbk, stackloss and starsCYG, beside those published with \
                 robustbase, and scikit-learn's.",
            )
            .must(&[OTHER_FLAGS.at_most(0.0), OTHER_THAN_PEER.at_most(0.0)]),
        runs("file", file::run)
            .about("A file of 1.2 GB, 10⁸ normal points of space in single precision.")
            .must(&[GAP.at_most(1e-9), PASSES.at_most(3.0), MEMORY.at_most((256 << 20) as f64)]),
    ],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_every_case_has_a_goal() {
        assert!(AREA.sections.iter().all(|section| !section.must.is_empty()));
    }
}
