//! Tables 2 and 3: people recognized by their hands, and breast cancer, by the methods of the thesis and by others.
//!
//! *What is rerun.* The scans of the thesis are not public: table 2 is on synthetic ones, whose errors are no errors of people, so that
//! methods can be compared with each other and not with the printed figures. Table 3 has the same data, with ten halves of our own; the
//! rows of the table add up only if its sensitivity is that of the benign class, which is the positive one here.

use rayon::prelude::*;
use taut_draw::{DetCurve, det_figure};
use taut_recognize::classify::{
    Cells, Method, Preset, PresetOptions, Rule, Scaling, TrainOptions, Width,
};
use taut_recognize::evaluate::{
    Attempt, Contender, DetPoint, HAND_COLUMNS, Protocol, ProtocolOptions, hand_contenders,
    hand_row, run_protocol,
};
use taut_recognize::hand::synthetic::Generator;
use taut_recognize::hand::{Hand, HandOptions};

use super::*;
use crate::recognize::classifiers::PEERS;
use crate::recognize::sets::{Reached, SPLITS, Set};

/// Table 2: errors in percent for 3, 4 and 5 training scans.
const TABLE_2: [(&str, [f64; 3]); 3] =
    [("box", [2.81, 1.74, 1.72]), ("ball", [1.53, 0.94, 0.39]), ("svm", [4.77, 0.93, 1.93])];

/// Table 3: accuracy, sensitivity and specificity in percent.
const TABLE_3: [(&str, [f64; 3]); 7] = [
    ("MEB", [95.96, 97.76, 92.92]),
    ("SVC", [91.75, 99.55, 78.58]),
    ("neural", [96.81, 98.55, 93.87]),
    ("Parzen", [95.79, 98.44, 91.32]),
    ("Fischer", [95.82, 99.27, 90.00]),
    ("k-nn", [94.60, 96.31, 91.70]),
    ("ldc", [95.72, 99.33, 89.62]),
];

/// The seed of the people of table 2: no method was chosen on them.
const SEED_UNSEEN: u64 = 29;

/// The number of a person, and the features of a scan of hers.
type Scan = (u32, Option<[f64; HAND_COLUMNS]>);

/// Measures the scans.
fn measured(plan: &Plan) -> Vec<Scan> {
    let (people, scans) = plan.context.size((70, 10), (12, 7));
    let generator = Generator { seed: SEED_UNSEEN, ..Generator::default() };
    let all: Vec<(u64, u64)> = (0..people).flat_map(|p| (0..scans).map(move |s| (p, s))).collect();
    let measure = |&(person, scan): &(u64, u64)| {
        let image = generator.scan(person, scan).image;
        (person as u32, Hand::from_rgb(&image, &HandOptions::default()).ok().map(|h| hand_row(&h)))
    };
    all.par_iter().map(measure).collect()
}

/// Runs the protocol.
fn rates(
    rows: &[Scan],
    contenders: &[Contender],
    (training, splits): (&[usize], usize),
) -> Result<Protocol> {
    let attempts: Vec<Attempt<'_>> = rows
        .iter()
        .map(|(person, row)| Attempt {
            person: *person,
            features: row.as_ref().map(|row| &row[..]),
        })
        .collect();
    let options =
        ProtocolOptions { training: training.to_vec(), splits, ..ProtocolOptions::default() };
    Ok(run_protocol(&attempts, contenders, &options)?)
}

/// Reruns table 2, and figures 57 to 60 with five training scans.
pub(super) fn table_2(plan: &Plan) -> Result<()> {
    let rows = measured(plan);
    let contenders = hand_contenders();
    let splits = plan.upto(&[5, 20, 100], 1, 2).last().copied().unwrap_or(5);
    let found = rates(&rows, &contenders, (&[3, 4, 5], splits))?;
    let mut csv = String::from(
        "table,data,method,training,errors,low,high,unseen,unseen_low,unseen_high,eer,frr,samples_wrong,samples\n",
    );
    for (name, errors) in TABLE_2 {
        for (training, error) in (3..).zip(errors) {
            writeln!(csv, "2,thesis,{name},{training},{error},,,,,,,,,")?;
        }
    }
    for row in &found.rows {
        let (name, training, seen, unseen) =
            (&contenders[row.contender].name, row.training, &row.seen, &row.unseen);
        let percent = |rates: &taut_recognize::evaluate::ProtocolRates| {
            [rates.error_rate(), rates.interval.low, rates.interval.high]
                .map(|rate| format!("{:.3}", 100.0 * rate))
                .join(",")
        };
        writeln!(
            csv,
            "2,synthetic,{name},{training},{},{},{:.3},{:.3},{},{}",
            percent(seen),
            percent(unseen),
            100.0 * seen.equal_error_rate,
            100.0 * seen.at.fnmr,
            seen.samples_wrong,
            seen.samples
        )?;
    }
    finish(plan, "table-2.csv", csv)?;
    println!(
        "Failure to acquire {:.2} % of {} scans, {splits} splits.",
        100.0 * found.fta,
        rows.len()
    );
    let curves = |of: &dyn Fn(usize) -> Vec<DetPoint>| {
        let last = found.rows.iter().enumerate().filter(|(_, row)| row.training == 5);
        let curve = |(at, row): (usize, &taut_recognize::evaluate::ProtocolRow)| DetCurve {
            name: contenders[row.contender].name.clone(),
            points: of(at).iter().map(|point| [point.fmr, point.fnmr]).collect(),
        };
        last.map(curve).collect::<Vec<_>>()
    };
    let caption =
        format!("Synthetic scans, 5 training scans of each person, {splits} random splits.");
    for (file, title, curves) in [
        ("figure-57-58", "Verification", curves(&|at| found.rows[at].seen.det.clone())),
        (
            "figure-59-60",
            "Identification",
            curves(&|at| found.rows[at].seen.identification.clone()),
        ),
    ] {
        let figure = det_figure(title, &caption, curves, &DrawOptions::default());
        let path = plan.out.join(format!("{file}.svg"));
        fs::write(&path, to_svg(&figure, &Style::default()))?;
        println!("{}", path.display());
    }
    Ok(())
}

/// Reruns figure 56: misclassifications by the width of the kernel, with five training scans and four splits.
pub(super) fn figure_56(plan: &Plan) -> Result<()> {
    let rows = measured(plan);
    let thetas: Vec<f64> = (2..=20).map(|k| 10f64.powf(f64::from(k) / 4.0)).collect();
    let ball = hand_contenders().into_iter().find(|contender| contender.name == "thesis-ball");
    let ball = ball.context("the classifier of the thesis")?;
    let mut figure = Figure::of_counts(56, "misclassified probes by θ in exp(−d²/θ)", "log10 θ")
        .note("The thesis: a wide choice of θ has few misclassifications; between 140 and 400 there were 0.75 on average.");
    for cells in [Cells::Voronoi, Cells::Power] {
        let contender = |&theta: &f64| {
            let width = Width::Theta { theta };
            let rule = Rule::Ball { width, cells, nu: None, steps: Some(100) };
            let method = Method { rule, ..ball.method };
            Contender { name: theta.to_string(), method, verifier: None, ..ball.clone() }
        };
        let contenders: Vec<Contender> = thetas.iter().map(contender).collect();
        let found = rates(&rows, &contenders, (&[5], 4))?;
        let errors = found.rows.iter().map(|row| row.seen.errors as f64 / 4.0);
        let points = thetas.iter().zip(errors).map(|(theta, errors)| [theta.log10(), errors]);
        figure.curves.push(Curve { name: format!("{cells} cells"), points: points.collect() });
    }
    figure.show(plan)
}

/// Reruns table 3.
pub(super) fn table_3(plan: &Plan) -> Result<()> {
    let Some(set) = Set::breast_cancer()? else { return Ok(()) };
    let mut csv =
        String::from("table,source,method,accuracy,spread,sensitivity,specificity,seconds\n");
    for (name, [accuracy, sensitivity, specificity]) in TABLE_3 {
        writeln!(csv, "3,thesis,{name},{accuracy},,{sensitivity},{specificity},")?;
    }
    let mut add = |source: &str, name: &str, reached: &Reached| -> Result<()> {
        // The benign class is the positive one.
        let percent = [reached.accuracy, reached.spread, reached.recalls[1], reached.recalls[0]];
        let percent = percent.map(|share| format!("{:.2}", 100.0 * share)).join(",");
        Ok(writeln!(csv, "3,{source},\"{name}\",{percent},{:.3}", reached.seconds)?)
    };
    for Row { name, candidates, committee } in methods()? {
        let options = TrainOptions { candidates, committee, ..TrainOptions::default() };
        add("taut", &name, &set.run(&options)?)?;
    }
    let (rows, columns) = set.table();
    for name in PEERS {
        match peer::ask(&plan.context, &format!("classify-{name}"), (&rows, columns))? {
            Err(why) => println!("left out: scikit-learn's {name}: {why}"),
            Ok(theirs) => {
                let (accuracies, recalls) = theirs.center.split_at(SPLITS.min(theirs.center.len()));
                let reached = Reached::of(accuracies, recalls.to_vec(), theirs.seconds);
                add("scikit-learn", name, &reached)?;
            }
        }
    }
    finish(plan, "table-3.csv", csv)
}

/// A row of table 3: candidates, and how near the best those of a committee come.
struct Row {
    name: String,
    candidates: Vec<Method>,
    committee: Option<f64>,
}

/// The classifier of the thesis under both conventions of the width and both rules, and ours.
fn methods() -> Result<Vec<Row>> {
    let mut all = vec![];
    let theta = 125.0;
    for (width, shown) in
        [(Width::ThetaSquared { theta }, "exp(−d²/125²)"), (Width::Theta { theta }, "exp(−d²/125)")]
    {
        for cells in [Cells::Power, Cells::Voronoi] {
            let rule = Rule::Ball { width, cells, nu: None, steps: Some(100) };
            let method = Method { scaling: Scaling::Percent, whitening: false, rule };
            let name = format!("ball, {shown}, {cells}");
            all.push(Row { name, candidates: vec![method], committee: None });
        }
    }
    for preset in [Preset::Box, Preset::Svm, Preset::Best, Preset::Committee] {
        let candidates = preset.candidates(&PresetOptions::default())?;
        let (name, committee) = (preset.to_string(), preset.committee());
        all.push(Row { name, candidates, committee });
    }
    Ok(all)
}

fn finish(plan: &Plan, file: &str, csv: String) -> Result<()> {
    print!("{csv}");
    let path = plan.out.join(file);
    fs::write(&path, csv)?;
    println!("{}", path.display());
    Ok(())
}
