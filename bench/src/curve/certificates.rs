//! Whether certificates can be believed: random trials of every kind, each with its truth.

use super::*;

/// Kinds of trials, by turns.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// Without noise, ε = 0.15.
    Dense,
    /// Without noise, ε between 0.3 and 0.95, where methods begin to go wrong.
    Sparse,
    /// Without noise, many points, a share of them left out along a stretch.
    Gap,
    /// Noise up to half the least feature, from few points to many.
    Noisy,
    /// Noise of 0.05 and points enough: the default method is right nearly always.
    DenseNoisy,
    /// The same with outliers.
    Outliers,
}

const KINDS: [(Kind, &str); 6] = [
    (Kind::Dense, "dense"),
    (Kind::Sparse, "sparse"),
    (Kind::Gap, "gap"),
    (Kind::Noisy, "noisy"),
    (Kind::DenseNoisy, "dense, noisy"),
    (Kind::Outliers, "outliers"),
];

const CLEAN_METHODS: [CurveMethod; 5] = [
    CurveMethod::Auto,
    CurveMethod::NnCrust,
    CurveMethod::HnnCrust,
    CurveMethod::Crust,
    CurveMethod::Corners,
];

/// A number in [0, 1) that the seed determines, another one for each `salt`.
fn lot(seed: u64, salt: u64) -> f64 {
    // The finalizer of SplitMix64.
    let mut x = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(salt);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((x ^ (x >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

/// One trial: truth, points and method.
fn draw(kind: Kind, seed: u64) -> (TruthCurves, Vec<f64>, CurveMethod) {
    let pick = |salt, of: usize| (lot(seed, salt) * of as f64) as usize;
    let truth = match TestCurve::named(CURVES[pick(1, CURVES.len())]) {
        Some(named) if pick(2, 4) == 0 => named.build_with(3000),
        _ => TestCurve::random(seed).build_with(3000),
    };
    let clean = CLEAN_METHODS[pick(3, CLEAN_METHODS.len())];
    let between = |salt, low: f64, high: f64| low + (high - low) * lot(seed, salt);
    let count = |per: f64| ((per * truth.length_over_feature) as usize).clamp(10, 20_000);
    let noisy = |n, delta, outliers| {
        let noise =
            CurveNoise { delta, outliers, gaussian: pick(4, 3) == 0, ..CurveNoise::default() };
        sample_curve(&truth, n, &noise, seed).points
    };
    let (points, method) = match kind {
        Kind::Dense => (epsilon_sample(&truth, 0.15, seed).points, clean),
        Kind::Sparse => (epsilon_sample(&truth, between(5, 0.3, 0.95), seed).points, clean),
        Kind::Gap => {
            let all = epsilon_sample(&truth, between(5, 0.1, 0.4), seed).points;
            // All but those in a disk around one of them.
            let middle = 2 * pick(6, all.len() / 2);
            let (x, y, radius) = (all[middle], all[middle + 1], between(7, 0.3, 3.0));
            let far = |p: &&[f64]| (p[0] - x).hypot(p[1] - y) > radius;
            (all.chunks_exact(2).filter(far).flatten().copied().collect(), clean)
        }
        Kind::Noisy => {
            (noisy(count(between(5, 2.0, 300.0)), between(6, 0.02, 0.5), 0.0), CurveMethod::Auto)
        }
        Kind::DenseNoisy => (noisy(count(200.0), 0.05, 0.0), CurveMethod::Auto),
        Kind::Outliers => {
            (noisy(count(between(5, 20.0, 200.0)), 0.05, between(6, 0.02, 0.3)), CurveMethod::Auto)
        }
    };
    (truth, points, method)
}

/// What became of a trial.
#[derive(Clone, Copy, Default)]
struct Trial {
    seed: u64,
    is_certified: bool,
    is_right: bool,
    is_rejected: bool,
}

impl Trial {
    fn run(seed: u64) -> Result<Self> {
        let (truth, points, method) = draw(kind_of(seed), seed);
        let options = CurveOptions { method, ..CurveOptions::default() };
        let (found, _) = solve(&points, &options)?;
        let verdict = found.check(&Points::new(&points, 2)?);
        let quality = compare(&true_lines(&truth), &found_lines(&found.answer));
        Ok(Trial {
            seed,
            // What the checker confirms counts, not what the solver claims.
            is_certified: verdict.as_ref().is_ok_and(|verdict| verdict.certified),
            is_right: quality.topology_right(),
            is_rejected: verdict.is_err(),
        })
    }

    fn is_wrong(&self) -> bool {
        self.is_certified && !self.is_right
    }
}

fn kind_of(seed: u64) -> Kind {
    KINDS[seed as usize % KINDS.len()].0
}

/// All trials.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let seeds = context.seeds.clone();
    let trials: Vec<Trial> =
        context.pool()?.install(|| seeds.into_par_iter().map(Trial::run).collect::<Result<_>>())?;
    let mut table =
        Table::new("trials | all | right | certified | wrongly | rejected | seeds of the wrong");
    for (kind, name) in KINDS {
        let of = || trials.iter().filter(|trial| kind_of(trial.seed) == kind);
        let count = |is: fn(&Trial) -> bool| of().filter(|trial| is(trial)).count();
        let (all, certified) = (of().count(), count(|trial| trial.is_certified));
        let wrong: Vec<u64> = of().filter(|trial| trial.is_wrong()).map(|t| t.seed).collect();
        table.push(json!({
            "trials": name, "all": all, "right": count(|trial| trial.is_right), "certified": certified,
            "wrongly": wrong.len(), "rejected": count(|trial| trial.is_rejected), "seeds of the wrong": few(&wrong),
            "wrong_seeds": wrong,
        }));
        if kind == Kind::Dense && all > 0 {
            let share = certified as f64 / all as f64;
            out.at_least("share of the dense trials certified", share, [0.7, 0.8], Unit::Percent);
        }
    }
    out.table("", table);
    let wrong = trials.iter().filter(|trial| trial.is_wrong()).count();
    out.must(format!("no false certificate in {}", trials.len()), wrong, wrong == 0);
    let rejected = trials.iter().filter(|trial| trial.is_rejected).count();
    out.must("no answer rejected by the checker", rejected, rejected == 0);
    Ok(())
}
