//! The list of cases.

use super::*;

pub(super) const BUDGET_STOPS: Quantity = Quantity::new("runs that a budget stopped", Unit::Plain);
/// Of the median time.
pub(super) const READS: Quantity =
    Quantity::new("plain reads of the same memory in the time taken", Unit::Times);
pub(super) const FASTER: Quantity =
    Quantity::new("time of the fastest peer over ours", Unit::Times);
pub(super) const SPEEDUP: Quantity = Quantity::new("speedup of two threads over one", Unit::Times);
pub(super) const SHARE: Quantity = Quantity::new("our time over that of each peer", Unit::Times);
/// Each peer gave the ball we proved, or what is wrong with its own is shown.
pub(super) const UNEXPLAINED: Quantity =
    Quantity::new("answers outside our certified bracket and not shown to be wrong", Unit::Plain);
pub(super) const OF_CAT: Quantity =
    Quantity::new("speed of each pass over that of cat", Unit::Times);

/// Whether a budget stopped a run, as a goal asks for it.
pub(super) fn stops(stop: Stop) -> (f64, String) {
    (f64::from(u8::from(stop != Stop::Converged)), format!("{stop:?}").to_lowercase())
}

/// The code of Fischer, Gärtner and Kutz, in two builds.
const FGK: &[&str] = &["fgk-native", "fgk-o2"];

/// No budget was used up.
const CONVERGED: Goal = BUDGET_STOPS.at_most(0.0);
const GAP_GOAL: Goal = GAP.at_most(1e-12);
/// Half the diagonals of cubes, √d / 2, by dimension, to 1e-12.
const fn half_diagonal(radius: f64) -> Goal {
    RADIUS.near(radius, 1e-12)
}

const NOISE: Distribution = Distribution::Shell { thickness: 1e-8 };

/// All sections; the longest is the last.
pub(crate) const AREA: Area<Run> = Area {
    name: "ball",
    runs: 9,
    threads: &[1, 2],
    limit: 60,
    peer_budget: 120,
    sections: &[
        runs("small", |run, out| points::run(run, out, Distribution::Normal, 1000, 3))
            .peers(&[
                "fgk-o2",
                "gaertner-o2",
                "cgal-spheres-3-o2",
                "cgal-min-sphere-3-o2",
                "cyminiball",
                "miniball-pypi",
                "miniball-crate",
            ])
            .about("Normal, 1000 × 3: every peer there is.")
            .must(&[GAP_GOAL]),
        runs("usps", points::run_usps)
            .peers(FGK)
            .about("USPS train, 7291 × 256, exact.")
            .must(&[RADIUS.near(13.479343686, 7e-10), GAP_GOAL]),
        runs("normal-300", |run, out| points::run(run, out, Distribution::Normal, 10_000, 300))
            .peers(FGK)
            .about("Normal, 10⁴ × 300, exact, beside the Fischer–Gärtner–Kutz code.")
            .must(&[GAP_GOAL, FASTER.at_least(170.0).beside(FGK)])
            .aim(&[FASTER.at_least(200.0).beside(FGK)]),
        runs("normal-500", |run, out| points::run(run, out, Distribution::Normal, 10_000, 500))
            .peers(FGK)
            .about("Normal, 10⁴ × 500, exact, beside the Fischer–Gärtner–Kutz code.")
            .must(&[GAP_GOAL, FASTER.at_least(190.0).beside(FGK)])
            .aim(&[FASTER.at_least(270.0).beside(FGK)]),
        runs("normal-1000", |run, out| points::run(run, out, Distribution::Normal, 10_000, 1000))
            .peers(FGK)
            .about("Normal, 10⁴ × 1000, exact, beside the Fischer–Gärtner–Kutz code.")
            .must(&[GAP_GOAL, FASTER.at_least(240.0).beside(FGK), SPEEDUP.at_least(1.7)])
            .aim(&[FASTER.at_least(400.0).beside(FGK), SPEEDUP.at_least(1.9)]),
        runs("cube-100", |run, out| points::run(run, out, Distribution::CubeVertices, 10_000, 100))
            .peers(FGK)
            .about("Vertices of the cube, 10⁴ × 100: cospherical, with r = √100 / 2.")
            .must(&[half_diagonal(5.0), GAP_GOAL, CONVERGED, SECONDS.at_most(0.3)])
            .aim(&[SECONDS.at_most(0.06)]),
        runs("cube-300", |run, out| points::run(run, out, Distribution::CubeVertices, 10_000, 300))
            .peers(FGK)
            .about("Vertices of the cube, 10⁴ × 300: r = √300 / 2.")
            .must(&[half_diagonal(8.660254037844387), GAP_GOAL, CONVERGED, SECONDS.at_most(0.3)])
            .aim(&[SECONDS.at_most(0.06)]),
        runs("cube-500", |run, out| points::run(run, out, Distribution::CubeVertices, 5_000, 500))
            .peers(FGK)
            .about("Vertices of the cube, 5000 × 500: r = √500 / 2.")
            .must(&[half_diagonal(11.180339887498949), GAP_GOAL, CONVERGED, SECONDS.at_most(0.3)])
            .aim(&[SECONDS.at_most(0.06)]),
        runs("cube-1500", |run, out| {
            points::run(run, out, Distribution::CubeVertices, 20_000, 1500)
        })
        .about("Vertices of the cube, 2·10⁴ × 1500: r = √1500 / 2.")
        .must(&[
            half_diagonal(19.364916731037084),
            GAP_GOAL,
            CONVERGED,
            SECONDS.at_most(5.0),
        ]),
        runs("shell-300", |run, out| points::run(run, out, NOISE, 10_000, 300))
            .peers(FGK)
            .about("A sphere with noise of 1e-8, 10⁴ × 300: the hardest family.")
            .must(&[GAP_GOAL, CONVERGED, SECONDS.at_most(0.5)])
            .aim(&[SECONDS.at_most(0.2)]),
        runs("shell-500", |run, out| points::run(run, out, NOISE, 10_000, 500))
            .about("A sphere with noise of 1e-8, 10⁴ × 500.")
            .must(&[GAP_GOAL, CONVERGED, SECONDS.at_most(1.5)])
            .aim(&[SECONDS.at_most(0.6)]),
        runs("large", points::run_largest)
            .about(
                "The size of the largest instance of the thesis (chapter 2), here normal: 10⁵ × 1500 \
                 in single precision, exact, beside plain reads.",
            )
            .must(&[GAP_GOAL, PASSES.at_most(5.0), READS.at_most(4.0), SPEEDUP.at_least(1.7)])
            .aim(&[READS.at_most(3.2), SPEEDUP.at_least(1.9)]),
        runs("plane", |run, out| points::run(run, out, Distribution::Normal, 1_000_000, 2))
            .peers(&["cgal-spheres-2-native", "cgal-min-sphere-2-native", "miniball-crate"])
            .about("Normal, 10⁶ × 2, exact, beside CGAL.")
            .must(&[GAP_GOAL, PLANE_THIRD])
            .aim(&[SHARE
                .at_most(0.1)
                .beside(&["cgal-spheres-2-native", "cgal-min-sphere-2-native"])]),
        runs("space", |run, out| points::run(run, out, Distribution::Normal, 1_000_000, 3))
            .peers(&["cgal-spheres-3-native", "cgal-min-sphere-3-native", "miniball-crate"])
            .about("Normal, 10⁶ × 3, exact, beside CGAL.")
            .must(&[GAP_GOAL, SPACE_THIRD])
            .aim(&[SHARE
                .at_most(0.1)
                .beside(&["cgal-spheres-3-native", "cgal-min-sphere-3-native"])]),
        runs("ten", |run, out| points::run(run, out, Distribution::Normal, 1_000_000, 10))
            .peers(&["cgal-spheres-10-native"])
            .about("Normal, 10⁶ × 10, exact, beside CGAL.")
            .must(&[GAP_GOAL, SHARE.at_most(1.0 / 8.0).beside(&["cgal-spheres-10-native"])])
            .aim(&[SHARE.at_most(1.0 / 12.0).beside(&["cgal-spheres-10-native"])]),
        runs("file", file::run)
            .about(
                "Normal, 10⁶ × 2500 in single precision, in a file of 10 GB, beside `cat FILE \
                 > /dev/null`.",
            )
            .must(&[
                GAP_GOAL,
                PASSES.at_most(8.0),
                MEMORY.at_most((1 << 30) as f64),
                OF_CAT.at_least(0.8),
            ]),
        runs("balls-3", |run, out| points::run_balls(run, out, 10_000, 3))
            .peers(&["cgal-balls-3-native"])
            .about("10⁴ balls in ℝ³ under six radius laws, beside CGAL.")
            .must(&[GAP_GOAL, UNEXPLAINED.at_most(0.0).beside(&["cgal-balls-3-native"])]),
        runs("balls-10", |run, out| points::run_balls(run, out, 10_000, 10))
            .peers(&["cgal-balls-10-native"])
            .about("10⁴ balls in ℝ¹⁰ under six radius laws, beside CGAL.")
            .must(&[GAP_GOAL, UNEXPLAINED.at_most(0.0).beside(&["cgal-balls-10-native"])]),
        runs("balls-100", |run, out| points::run_balls(run, out, 10_000, 100))
            .about("10⁴ balls in ℝ¹⁰⁰ under six radius laws.")
            .must(&[GAP_GOAL]),
        runs("balls-300", |run, out| points::run_balls(run, out, 10_000, 300))
            .about("10⁴ balls in ℝ³⁰⁰ under six radius laws.")
            .must(&[GAP_GOAL]),
        runs("balls-1000", |run, out| points::run_balls(run, out, 100_000, 1000))
            .about("10⁵ balls in ℝ¹⁰⁰⁰ under six radius laws, beside plain reads.")
            .must(&[GAP_GOAL, READS.at_most(20.0)]),
        runs("core-sets", core_sets::run).about(
            "Core-set sizes at ε = 1e-3 with one far point per pass, as the thesis counts \
                 them (figures 8, 10, 12).",
        ),
        runs("threads", threads::run)
            .about("Whole answers as JSON, byte for byte, for 1, 2 and 8 threads."),
    ],
};

const PLANE_THIRD: Goal =
    SHARE.at_most(1.0 / 3.0).beside(&["cgal-spheres-2-native", "cgal-min-sphere-2-native"]);
const SPACE_THIRD: Goal =
    SHARE.at_most(1.0 / 3.0).beside(&["cgal-spheres-3-native", "cgal-min-sphere-3-native"]);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_goals_speak_of_peers_that_run() {
        for case in AREA.sections {
            for goal in case.must.iter().chain(case.aim) {
                assert!(goal.peers.iter().all(|peer| case.peers.contains(peer)), "{}", case.name);
            }
        }
    }
}
