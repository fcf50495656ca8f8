//! What each figure measures.

use std::time::Instant;

use anyhow::Result;
use taut_draw::Scale;
use taut_enclose::{BallMethod, BallOptions, ball};
use taut_points::Distribution;

use super::Plan;
use super::figure::{Curve, Figure};
use crate::input::Input;
use crate::judge::judge;
use crate::peer::Peer;

/// Reruns one experiment, which gives one figure or two.
type Draw = fn(&Plan) -> Result<Vec<Figure>>;

/// Numbers of the figures and the experiment that gives them.
pub(super) const FIGURES: &[(&[u32], Draw)] = &[
    (&[5, 6], pure_and_fast),
    (&[7, 8], two_numbers_of_points),
    (&[9, 10], four_distributions),
    (&[11, 12], by_epsilon),
    (&[13], low_dimensions),
    (&[14], beside_exact_codes),
    (&[15], beside_badoiu_clarkson),
];

/// A method of ours and the name of its curve.
#[derive(Clone)]
struct Way {
    name: String,
    options: BallOptions<'static>,
}

impl Way {
    fn new(name: impl Into<String>, method: BallMethod, epsilon: f64) -> Self {
        Way {
            name: name.into(),
            options: BallOptions { method, epsilon, ..BallOptions::default() },
        }
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
}

/// One value of each curve of one way.
struct Value {
    x: f64,
    seconds: f64,
    core_set: f64,
    support: f64,
}

/// Solves the instances in order until the budget of the plan is used up; says where it stopped.
fn sweep<X: Copy + Into<f64>>(
    plan: &Plan,
    way: &Way,
    instances: &[X],
    input: impl Fn(X) -> Result<Input>,
    notes: &mut Vec<String>,
) -> Result<Vec<Value>> {
    let mut values = Vec::new();
    let mut used = 0.0;
    for &x in instances {
        if used > plan.budget.as_secs_f64() {
            notes.push(format!(
                "“{}” stops before {}: its budget of time is used up.",
                way.name,
                x.into()
            ));
            break;
        }
        let input = input(x)?;
        values.push(measure(plan, way, x.into(), &input, &mut used, notes)?);
    }
    Ok(values)
}

fn measure(
    plan: &Plan,
    way: &Way,
    x: f64,
    input: &Input,
    used: &mut f64,
    notes: &mut Vec<String>,
) -> Result<Value> {
    let source = input.source()?;
    let mut best = f64::INFINITY;
    let mut last = None;
    for _ in 0..plan.runs {
        let start = Instant::now();
        let found = ball(&*source, &BallOptions { inputs: input.items, ..way.options })?;
        let seconds = start.elapsed().as_secs_f64();
        best = best.min(seconds);
        *used += seconds;
        last = Some(found);
    }
    let Some(found) = last else { anyhow::bail!("no run") };
    // Checked outside the time; a rejected answer is not drawn in silence.
    match found.check(&*source) {
        Ok(verdict) if verdict.gap <= way.options.epsilon.max(1e-12) => {}
        Ok(verdict) => {
            notes.push(format!("“{}” at {x}: the gap reached is {:.1e}.", way.name, verdict.gap))
        }
        Err(error) => {
            notes.push(format!("“{}” at {x} is REJECTED by the checker: {error}.", way.name))
        }
    }
    Ok(Value {
        x,
        seconds: best,
        core_set: found.trace.core_set as f64,
        support: found.certificate.support.len() as f64,
    })
}

fn curve(name: impl Into<String>, values: &[Value], pick: impl Fn(&Value) -> f64) -> Curve {
    Curve { name: name.into(), points: values.iter().map(|v| [v.x, pick(v)]).collect() }
}

/// Figures of time and of core-set size over the same instances.
struct Pair {
    times: Figure,
    sizes: Figure,
}

impl Pair {
    fn new(numbers: [u32; 2], of: &str, x: &'static str) -> Self {
        let figure = |number, y, unit, title: &str, scale| Figure {
            number,
            part: "",
            title: format!("{title}, {of}"),
            x,
            y,
            unit,
            scale,
            curves: Vec::new(),
            notes: Vec::new(),
        };
        Pair {
            times: figure(numbers[0], "time", "s", "running time", Scale::Log),
            sizes: figure(numbers[1], "points", "", "core-set size", Scale::Linear),
        }
    }

    fn add<X: Copy + Into<f64>>(
        &mut self,
        plan: &Plan,
        way: &Way,
        instances: &[X],
        input: impl Fn(X) -> Result<Input>,
    ) -> Result<()> {
        let mut notes = Vec::new();
        let values = sweep(plan, way, instances, input, &mut notes)?;
        self.times.notes.extend(notes.iter().cloned());
        self.sizes.notes.extend(notes);
        self.times.curves.push(curve(&way.name, &values, |v| v.seconds));
        if way.options.method == BallMethod::CoreSet && way.options.batch.is_none() {
            self.sizes.curves.push(curve(format!("{}: support", way.name), &values, |v| v.support));
            self.sizes
                .curves
                .push(curve(format!("{}: working set", way.name), &values, |v| v.core_set));
        } else {
            self.sizes.curves.push(curve(&way.name, &values, |v| v.core_set));
        }
        Ok(())
    }

    fn note(&mut self, times: &str, sizes: &str) {
        self.times.notes.insert(0, times.to_owned());
        self.sizes.notes.insert(0, sizes.to_owned());
    }

    fn into_figures(self) -> Vec<Figure> {
        vec![self.times, self.sizes]
    }
}

const DIMS: &[u32] = &[50, 100, 200, 300, 400, 500, 600, 800, 1000];
const EPSILON: f64 = 1e-3;

fn pure_and_fast(plan: &Plan) -> Result<Vec<Figure>> {
    let mut pair = Pair::new([5, 6], "10⁴ normal points, ε = 0.001", "dimension");
    let dims = plan.upto(DIMS, 1, 5);
    let input = |d: u32| Input::points(Distribution::Normal, 10_000, d as usize);
    for way in [
        Way::new("Algorithm 1, pure", BallMethod::ThesisPure, EPSILON),
        Way::new("Algorithm 1, fast", BallMethod::ThesisFast, EPSILON),
        Way::one_per_pass("taut, one far point per pass", EPSILON),
        Way::default_exact("taut, exact"),
    ] {
        pair.add(plan, &way, dims, input)?;
    }
    pair.note(
        "The thesis: the fast variant is the faster, with core-sets of about the same size.",
        "The thesis: both variants give core-sets of essentially the same size.",
    );
    Ok(pair.into_figures())
}

fn two_numbers_of_points(plan: &Plan) -> Result<Vec<Figure>> {
    let mut pair = Pair::new([7, 8], "normal points, ε = 0.001, fast variant", "dimension");
    const DIMS_TO_1500: &[u32] = &[50, 100, 200, 300, 400, 500, 600, 800, 1000, 1250, 1500];
    let dims = plan.upto(DIMS_TO_1500, 1, 5);
    for n in if plan.size == super::Size::Quick { &[10_000][..] } else { &[10_000, 100_000] } {
        let input = |d: u32| Input::points(Distribution::Normal, *n, d as usize);
        pair.add(
            plan,
            &Way::new(format!("fast, n = {n}"), BallMethod::ThesisFast, EPSILON),
            dims,
            input,
        )?;
        let one = Way::one_per_pass(format!("taut, one far point per pass, n = {n}"), EPSILON);
        pair.add(plan, &one, dims, input)?;
        pair.add(plan, &Way::default_exact(format!("taut, exact, n = {n}")), dims, input)?;
    }
    pair.note(
        "The thesis: 10⁵ points in dimension 1500 in under 17 minutes.",
        "The thesis: sizes between 30 and 170, growing slowly with the dimension.",
    );
    Ok(pair.into_figures())
}

fn four_distributions(plan: &Plan) -> Result<Vec<Figure>> {
    let mut pair = Pair::new([9, 10], "10⁴ points, ε = 0.001, fast variant", "dimension");
    let dims = plan.upto(DIMS, 1, 4);
    for distribution in [
        Distribution::Uniform,
        Distribution::Normal,
        Distribution::Poisson,
        Distribution::CubeVertices,
    ] {
        let input = |d: u32| Input::points(distribution, 10_000, d as usize);
        pair.add(
            plan,
            &Way::new(distribution.to_string(), BallMethod::ThesisFast, EPSILON),
            dims,
            input,
        )?;
    }
    pair.note(
        "The thesis: vertices of the cube take by far the longest, and not monotonically in the dimension.",
        "The thesis: sizes between 30 and 170.",
    );
    Ok(pair.into_figures())
}

fn by_epsilon(plan: &Plan) -> Result<Vec<Figure>> {
    let mut pair = Pair::new([11, 12], "USPS and 10⁴ normal points, d = 256", "log2(1/ε)");
    let powers = plan.upto(&[2u32, 4, 6, 8, 10, 12, 14, 16], 1, 6);
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
            pair.times.notes.push(note.to_owned());
            pair.sizes.notes.push(note.to_owned());
        }
    }
    for (input, name, method) in named {
        let (mut values, mut notes, mut used) = (Vec::new(), Vec::new(), 0.0);
        for &power in powers {
            let way = Way::new(name, method, 0.5f64.powi(power as i32));
            values.push(measure(plan, &way, power.into(), input, &mut used, &mut notes)?);
        }
        pair.times.curves.push(curve(name, &values, |v| v.seconds));
        pair.sizes.curves.push(curve(name, &values, |v| v.core_set));
        pair.times.notes.extend(notes.iter().cloned());
        pair.sizes.notes.extend(notes);
    }
    pair.note(
        "The thesis: the time grows about linearly in log 1/ε on USPS.",
        "The thesis: on USPS the size grows about as log 1/ε, and is always 30 for the fast variant.",
    );
    Ok(pair.into_figures())
}

fn low_dimensions(plan: &Plan) -> Result<Vec<Figure>> {
    let mut figure = Figure {
        number: 13,
        part: "",
        title: "running time in low dimension, normal points, fast variant".into(),
        x: "log10 n",
        y: "time",
        unit: "s",
        scale: Scale::Log,
        curves: Vec::new(),
        notes: vec![],
    };
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
            let values = sweep(plan, &way, powers, input, &mut figure.notes)?;
            figure.curves.push(curve(&way.name, &values, |v| v.seconds));
            if way.options.method != BallMethod::CoreSet {
                largest = values.iter().fold(largest, |max, value| max.max(value.core_set));
            }
        }
    }
    figure.notes.insert(
        0,
        "The thesis: core-sets are always smaller than 10, and ε makes no difference.".into(),
    );
    figure.notes.insert(
        1,
        format!("Here the largest core-set of the thesis' method has {largest} points."),
    );
    Ok(vec![figure])
}

fn beside_exact_codes(plan: &Plan) -> Result<Vec<Figure>> {
    let mut figure = Figure {
        number: 14,
        part: "",
        title: "running time beside other codes, 1000 normal points, ε = 1e-6".into(),
        x: "dimension",
        y: "time",
        unit: "s",
        scale: Scale::Log,
        curves: Vec::new(),
        notes: vec![
            "The thesis: each of the exact codes for fixed dimension has a dimension beyond which its time rises sharply."
                .into(),
            "Gärtner's code is the header of 2013 that cyminiball wraps, not the one of 2003.".into(),
        ],
    };
    let dims = plan.upto(&[2u32, 3, 4, 5, 6, 8, 10, 12, 14, 16, 20, 25, 30], 3, 13);
    let input = |d: u32| Input::points(Distribution::Normal, 1000, d as usize);
    for way in [
        Way::new("Algorithm 1, pure", BallMethod::ThesisPure, 1e-6),
        Way::default_exact("taut, exact"),
    ] {
        let values = sweep(plan, &way, dims, input, &mut figure.notes)?;
        figure.curves.push(curve(&way.name, &values, |v| v.seconds));
    }
    for (title, program) in [
        ("CGAL", "cgal-spheres-{d}-native"),
        ("Gärtner", "gaertner-native"),
        ("Fischer, Gärtner, Kutz", "fgk-o2"),
    ] {
        let mut points = Vec::new();
        let mut used = 0.0;
        for &d in dims {
            if used > plan.budget.as_secs_f64() {
                figure
                    .notes
                    .push(format!("“{title}” stops before {d}: its budget of time is used up."));
                break;
            }
            let program = program.replace("{d}", &d.to_string());
            match ask(plan, &program, &input(d)?)? {
                Ok((seconds, warning)) => {
                    used += seconds * plan.runs as f64;
                    points.push([f64::from(d), seconds]);
                    figure
                        .notes
                        .extend(warning.map(|warning| format!("“{title}” at {d}: {warning}.")));
                }
                Err(silence) => {
                    figure.notes.push(format!("“{title}” stops at {d}: {silence}."));
                    break;
                }
            }
        }
        figure.curves.push(Curve { name: title.to_owned(), points });
    }
    Ok(vec![figure])
}

/// The best time of a peer on `input`, and a warning when its answer is wrong; or why there is none.
fn ask(
    plan: &Plan,
    program: &str,
    input: &Input,
) -> Result<Result<(f64, Option<String>), crate::peer::Silence>> {
    let path = plan.temp.path().join("input.bin");
    input.write(&path)?;
    let source = input.source()?;
    let exact = BallOptions { epsilon: 0.0, ..BallOptions::default() };
    let bracket = ball(&*source, &BallOptions { inputs: input.items, ..exact })?.check(&*source)?;
    let mut peer = match Peer::start(program, &path, plan.temp.path())? {
        Ok(peer) => peer,
        Err(silence) => return Ok(Err(silence)),
    };
    let (mut best, mut warning) = (f64::INFINITY, None);
    for _ in 0..plan.runs {
        match peer.solve(plan.budget)? {
            Ok(answer) => {
                best = best.min(answer.seconds);
                let judgement =
                    judge(&*source, input.items, &answer.center, answer.radius, &bracket)?;
                warning = judgement.is_wrong().then(|| judgement.to_string()).or(warning);
            }
            Err(silence) => return Ok(Err(silence)),
        }
    }
    Ok(Ok((best, warning)))
}

fn beside_badoiu_clarkson(plan: &Plan) -> Result<Vec<Figure>> {
    let mut figure = Figure {
        number: 15,
        part: "",
        title: "running time beside the method of Bădoiu and Clarkson, 1000 normal points".into(),
        x: "dimension",
        y: "time",
        unit: "s",
        scale: Scale::Log,
        curves: Vec::new(),
        notes: vec![
            "The thesis: at ε = 0.03 that method is already very slow compared to Algorithm 1."
                .into(),
        ],
    };
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
        let values = sweep(plan, &way, dims, input, &mut figure.notes)?;
        figure.curves.push(curve(&way.name, &values, |v| v.seconds));
    }
    Ok(vec![figure])
}
