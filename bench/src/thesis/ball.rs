//! Figures 5 to 15: core-set sizes and times of Algorithm 1 for balls, pure and fast, by dimension, number of points,
//! distribution and ε, and its time beside CGAL, Gärtner's code and the simple method of Bădoiu and Clarkson.

use super::*;
use taut_enclose::ball;

/// A method of ours and the name of its curve.
#[derive(Clone)]
struct Way {
    name: String,
    options: BallOptions<'static>,
}

impl Way {
    fn new(name: impl Into<String>, method: BallMethod, epsilon: f64) -> Self {
        let options = BallOptions { method, epsilon, ..BallOptions::default() };
        Way { name: name.into(), options }
    }

    /// taut's default method held to one far point per pass, as the thesis has it.
    fn one_per_pass(name: impl Into<String>, epsilon: f64) -> Self {
        let mut way = Way::new(name, BallMethod::CoreSet, epsilon);
        way.options.batch = Some(1);
        way
    }

    /// taut's default method, to the last digit.
    fn default_exact(name: impl Into<String>) -> Self {
        Way::new(name, BallMethod::CoreSet, 0.0)
    }

    fn is_default(&self) -> bool {
        self.options.method == BallMethod::CoreSet && self.options.batch.is_none()
    }

    fn measure(&self, plan: &Plan, x: f64, input: &Input) -> Result<Measured> {
        let source = input.source()?;
        let options = BallOptions { inputs: input.items, ..self.options };
        let (found, seconds) = plan.best_of(|| Ok(ball(&*source, &options)?))?;
        // Checked outside the time.
        let gap = found.check(&*source).map(|verdict| verdict.gap);
        Ok(Measured {
            x,
            seconds,
            core_set: found.trace.core_set as f64,
            support: found.certificate.support.len() as f64,
            warning: warning(gap, self.options.epsilon.max(1e-12)),
        })
    }

    fn sweep<X: Copy + Into<f64>>(
        &self,
        plan: &Plan,
        instances: &[X],
        input: impl Fn(X) -> Result<Input>,
    ) -> Result<Sweep> {
        let measure = |x: X| Ok(Ok(self.measure(plan, x.into(), &input(x)?)?));
        Sweep::run(plan, &self.name, plan.context.limit, instances, X::into, measure)
    }
}

/// Figures of time and of core-set size over the same instances.
struct Pair {
    times: Figure,
    sizes: Figure,
}

impl Pair {
    fn new(numbers: [u32; 2], of: &str, x: &'static str, [times, sizes]: [&str; 2]) -> Self {
        Pair {
            times: Figure::of_times(numbers[0], format!("running time, {of}"), x).note(times),
            sizes: Figure::of_sizes(numbers[1], format!("core-set size, {of}"), x).note(sizes),
        }
    }

    /// Adds curves over the dimension, of n points of a distribution.
    fn add(
        &mut self,
        plan: &Plan,
        dims: &[u32],
        (distribution, n): (Distribution, usize),
        ways: &[Way],
    ) -> Result<()> {
        for way in ways {
            let input = |d: u32| Input::points(distribution, n, d as usize);
            self.draw(&way.sweep(plan, dims, input)?, way.is_default());
        }
        Ok(())
    }

    fn draw(&mut self, sweep: &Sweep, is_default: bool) {
        sweep.draw(&mut self.times, "", |value| value.seconds);
        if is_default {
            sweep.draw(&mut self.sizes, ": support", |value| value.support);
            sweep.draw(&mut self.sizes, ": working set", |value| value.core_set);
        } else {
            sweep.draw(&mut self.sizes, "", |value| value.core_set);
        }
    }

    fn show(self, plan: &Plan) -> Result<()> {
        self.times.show(plan)?;
        self.sizes.show(plan)
    }
}

const DIMS: &[u32] = &[50, 100, 200, 300, 400, 500, 600, 800, 1000];
const EPSILON: f64 = 1e-3;

pub(super) fn pure_and_fast(plan: &Plan) -> Result<()> {
    let notes = [
        "The thesis (2.4): the fast variant is much faster, with core-sets of essentially the same size.",
        "The thesis (2.4): both variants give core-sets of essentially the same size.",
    ];
    let mut pair = Pair::new([5, 6], "10⁴ normal points, ε = 0.001", "dimension", notes);
    let dims = plan.upto(DIMS, 1, 5);
    let ways = [
        Way::new("Algorithm 1, pure", BallMethod::ThesisPure, EPSILON),
        Way::new("Algorithm 1, fast", BallMethod::ThesisFast, EPSILON),
        Way::one_per_pass("taut, one far point per pass", EPSILON),
        Way::default_exact("taut, exact"),
    ];
    pair.add(plan, dims, (Distribution::Normal, 10_000), &ways)?;
    pair.show(plan)
}

pub(super) fn two_numbers_of_points(plan: &Plan) -> Result<()> {
    let notes = [
        "The thesis (chapter 2): 10⁵ points in dimension 1500 in less than 17 minutes.",
        "The thesis (2.4): sizes between 30 and 170, growing somewhat with the dimension.",
    ];
    let of = "normal points, ε = 0.001, fast variant";
    let mut pair = Pair::new([7, 8], of, "dimension", notes);
    const DIMS_TO_1500: &[u32] = &[50, 100, 200, 300, 400, 500, 600, 800, 1000, 1250, 1500];
    let dims = plan.upto(DIMS_TO_1500, 1, 5);
    for n in if plan.size == Size::Quick { &[10_000][..] } else { &[10_000, 100_000] } {
        let ways = [
            Way::new(format!("fast, n = {n}"), BallMethod::ThesisFast, EPSILON),
            Way::one_per_pass(format!("taut, one far point per pass, n = {n}"), EPSILON),
            Way::default_exact(format!("taut, exact, n = {n}")),
        ];
        pair.add(plan, dims, (Distribution::Normal, *n), &ways)?;
    }
    pair.show(plan)
}

pub(super) fn four_distributions(plan: &Plan) -> Result<()> {
    let notes = [
        "The thesis (2.4): vertices of the cube take the longest, and not monotonically in the \
            dimension.",
        "The thesis (2.4): sizes between 30 and 170.",
    ];
    let of = "10⁴ points, ε = 0.001, fast variant";
    let mut pair = Pair::new([9, 10], of, "dimension", notes);
    let dims = plan.upto(DIMS, 1, 4);
    for distribution in [
        Distribution::Uniform,
        Distribution::Normal,
        Distribution::Poisson,
        Distribution::CubeVertices,
    ] {
        let way = Way::new(distribution.to_string(), BallMethod::ThesisFast, EPSILON);
        pair.add(plan, dims, (distribution, 10_000), &[way])?;
    }
    pair.show(plan)
}

pub(super) fn by_epsilon(plan: &Plan) -> Result<()> {
    let notes = [
        "The thesis (2.4) says of the size alone how it grows: see figure 12.",
        "The thesis (2.4): on USPS the size grows about as log 1/ε, and is always 30 for the fast \
            variant.",
    ];
    let of = "USPS and 10⁴ normal points, d = 256";
    let mut pair = Pair::new([11, 12], of, "log2(1/ε)", notes);
    let powers = plan.upto(&[2u32, 4, 6, 8, 10, 12, 14, 16, 18, 20], 1, 6);
    let normal = Input::points(Distribution::Normal, 10_000, 256)?;
    let usps = Input::usps()?;
    let mut named = vec![(&normal, "normal, fast", BallMethod::ThesisFast)];
    match &usps {
        Some(usps) => named.extend([
            (usps, "USPS, pure", BallMethod::ThesisPure),
            (usps, "USPS, fast", BallMethod::ThesisFast),
        ]),
        None => {
            let note = "USPS is left out: set TAUT_DATA to a folder with ball/usps_train.csv.xz.";
            pair = Pair { times: pair.times.note(note), sizes: pair.sizes.note(note) };
        }
    }
    for (input, name, method) in named {
        // All powers, however long they take.
        let sweep = Sweep::run(plan, name, Duration::MAX, powers, f64::from, |power| {
            let way = Way::new(name, method, 0.5f64.powi(power as i32));
            way.measure(plan, power.into(), input).map(Ok)
        })?;
        pair.draw(&sweep, false);
    }
    pair.show(plan)
}

pub(super) fn low_dimensions(plan: &Plan) -> Result<()> {
    let title = "running time in low dimension, normal points, fast variant";
    let mut figure = Figure::of_times(13, title, "log10 n")
        .note("The thesis: core-sets are always smaller than 10, and ε makes no difference.");
    let powers = plan.upto(&[3.0, 3.5, 4.0, 4.5, 5.0, 5.5, 6.0], 2, 7);
    let mut largest = 0.0f64;
    for d in [2, 3] {
        let input =
            |power: f64| Input::points(Distribution::Normal, 10f64.powf(power).round() as usize, d);
        for way in [
            Way::new(format!("d = {d}, ε = 1e-3"), BallMethod::ThesisFast, 1e-3),
            Way::new(format!("d = {d}, ε = 1e-6"), BallMethod::ThesisFast, 1e-6),
            Way::default_exact(format!("d = {d}, taut, exact")),
        ] {
            let sweep = way.sweep(plan, powers, input)?;
            sweep.draw(&mut figure, "", |value| value.seconds);
            if !way.is_default() {
                largest = sweep.values.iter().fold(largest, |max, value| max.max(value.core_set));
            }
        }
    }
    let note = format!("Here the largest core-set of the thesis' method has {largest} points.");
    figure.note(note).show(plan)
}

pub(super) fn beside_exact_codes(plan: &Plan) -> Result<()> {
    let title = "running time beside other codes, 1000 normal points, ε = 1e-6";
    let mut figure = Figure::of_times(14, title, "dimension")
        .note(
            "The thesis: each of the exact codes for fixed dimension has a dimension beyond \
            which its time rises sharply.",
        )
        .note("Gärtner's code is the header of 2013 that cyminiball wraps, not the one of 2003.");
    let dims = plan.upto(&[2u32, 3, 4, 5, 6, 8, 10, 12, 14, 16, 20, 25, 30], 3, 13);
    let input = |d: u32| Input::points(Distribution::Normal, 1000, d as usize);
    for way in [
        Way::new("Algorithm 1, pure", BallMethod::ThesisPure, 1e-6),
        Way::default_exact("taut, exact"),
    ] {
        way.sweep(plan, dims, input)?.draw(&mut figure, "", |value| value.seconds);
    }
    for (title, program) in [
        ("CGAL", "cgal-spheres-{d}-native"),
        ("Gärtner", "gaertner-native"),
        ("Fischer, Gärtner, Kutz", "fgk-o2"),
    ] {
        let sweep = Sweep::run(plan, title, plan.context.limit, dims, f64::from, |d| {
            ask(plan, d.into(), &program.replace("{d}", &d.to_string()), &input(d)?)
        })?;
        sweep.draw(&mut figure, "", |value| value.seconds);
    }
    figure.show(plan)
}

/// The best time of a peer on `input`, with a warning when its answer is wrong; or why there is none.
fn ask(plan: &Plan, x: f64, program: &str, input: &Input) -> Result<Result<Measured, Silence>> {
    let context = &plan.context;
    let (answers, silence) = peer::ask_often(context, program, input.rows()?, context.runs)?;
    if let Some(silence) = silence {
        return Ok(Err(silence));
    }
    let source = input.source()?;
    let options = BallOptions { epsilon: 0.0, inputs: input.items, ..BallOptions::default() };
    let bracket = ball(&*source, &options)?.check(&*source)?;
    let (mut seconds, mut warning) = (f64::INFINITY, None);
    for answer in answers {
        seconds = seconds.min(answer.seconds);
        let judged = judge(&*source, input.items, &answer.center, answer.radius, &bracket)?;
        warning = judged.is_wrong().then(|| judged.to_string()).or(warning);
    }
    Ok(Ok(Measured { x, seconds, core_set: f64::NAN, support: f64::NAN, warning }))
}

pub(super) fn beside_badoiu_clarkson(plan: &Plan) -> Result<()> {
    let title = "running time beside the method of Bădoiu and Clarkson, 1000 normal points";
    let mut figure = Figure::of_times(15, title, "dimension").note(
        "The thesis (2.4): at ε = 0.03 that method is already very slow compared to Algorithm 1.",
    );
    let dims = plan.upto(&[10u32, 25, 50, 100, 150, 200, 300, 500], 2, 6);
    let input = |d: u32| Input::points(Distribution::Normal, 1000, d as usize);
    let simple = |epsilon: f64| {
        Way::new(format!("Bădoiu–Clarkson, ε = {epsilon}"), BallMethod::BadoiuClarkson, epsilon)
    };
    for way in [
        Way::new("Algorithm 1, pure, ε = 0.001", BallMethod::ThesisPure, EPSILON),
        simple(0.1),
        simple(0.05),
        simple(0.03),
        Way::default_exact("taut, exact"),
    ] {
        way.sweep(plan, dims, input)?.draw(&mut figure, "", |value| value.seconds);
    }
    figure.show(plan)
}

/// The experiment on δ of 2.4: sizes, radii and times of the pure variant by the accuracy of the conic solver.
pub(super) fn by_delta(plan: &Plan) -> Result<()> {
    let (n, d) = if plan.size == Size::Quick { (500, 50) } else { (5000, 500) };
    let powers = plan.upto(&[3, 9, 6, 4, 5, 7, 8], 2, 3);
    let mut csv = String::from("distribution,n,d,delta,core_set,radius,gap,seconds\n");
    for distribution in [Distribution::Normal, Distribution::CubeVertices] {
        let input = Input::points(distribution, n, d)?;
        let source = input.source()?;
        for &power in powers {
            let delta = 0.1f64.powi(power);
            let mut way = Way::new("pure", BallMethod::ThesisPure, EPSILON);
            way.options.delta = Some(delta);
            let (found, seconds) = plan.best_of(|| Ok(ball(&*source, &way.options)?))?;
            let gap = found.check(&*source)?.gap;
            let (core_set, radius) = (found.trace.core_set, found.answer.radius);
            writeln!(
                csv,
                "{distribution},{n},{d},1e-{power},{core_set},{radius:.6},{gap:.2e},{seconds:.3}"
            )?;
        }
    }
    print!("{csv}");
    println!(
        "The thesis (2.4), δ from 1e-3 to 1e-9: normal, always 75 points and radius 24.094 in 81.3 to 81.9 s; hypercube, always the same \
         size and radius in 669.64 to 691.7 s. The radius is that of (1 + ε)-approximations of its own points.\n"
    );
    Ok(fs::write(plan.out.join("section-2.4-delta.csv"), csv)?)
}

/// The instance that chapter 2 names first: 10⁵ normal points in dimension 1500 by the fast variant.
pub(super) fn largest(plan: &Plan) -> Result<()> {
    let (n, d) = match plan.size {
        Size::Quick => (1000, 150),
        Size::Usual => (10_000, 1500),
        Size::Full => (100_000, 1500),
    };
    let input = Input::points(Distribution::Normal, n, d)?;
    let mut csv = String::from("method,n,d,core_set,support,seconds,warning\n");
    for way in [
        Way::new("Algorithm 1, fast", BallMethod::ThesisFast, EPSILON),
        Way::default_exact("taut, exact"),
    ] {
        let Measured { core_set, support, seconds, warning, .. } =
            way.measure(plan, d as f64, &input)?;
        let warning = warning.unwrap_or_default();
        writeln!(csv, "\"{}\",{n},{d},{core_set},{support},{seconds:.3},{warning}", way.name)?;
    }
    print!("{csv}");
    println!(
        "The thesis (chapter 2): 10⁵ points in dimension 1500 in less than 17 minutes, ε = 0.001.\n"
    );
    Ok(fs::write(plan.out.join("chapter-2-largest.csv"), csv)?)
}
