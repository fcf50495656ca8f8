//! k centers: first the farthest-first traversal, whose bound is a factor of two, then the branches that prove the bound of the answer.

use serde_json::Value;
use taut::certify::{LowerBound, Placement};
use taut::{CentersOptions, FarthestFirstOptions, centers, farthest_first};
use taut_draw::{Figure, LineStyle, Tone};
use taut_report::numbers::{count, counted, gap, short};

use super::branches::{CASES_MAX, Case, cases};
use super::frame::{Frame, circles, cloud, marked};
use super::{POINTS_MAX, Table, Trace, ball_of, place, said};
use crate::input::Opened;
use crate::options::Options;
use crate::tools::centers::K_DEFAULT;

/// Most nodes of the search behind the steps.
const NODES_MAX: u64 = 200_000;

/// Most centers: as many as there are tones that can be told apart.
const K_MAX: u64 = 12;

/// The tones of balls, in turn.
const TONES: [Tone; 5] = [Tone::Answer, Tone::Second, Tone::Third, Tone::Bound, Tone::Fourth];

/// The steps: greedy ones, cases of the proof, and the answer.
#[derive(Debug)]
pub(super) struct Search {
    table: Table,
    k: usize,
    /// Rows in farthest-first order, and the radius after each.
    greedy: Vec<(usize, f64)>,
    next: Option<usize>,
    core_set: Vec<usize>,
    cases: Vec<Case>,
    /// Says why cases are left out, if they are.
    remark: &'static str,
    centers: Vec<Vec<f64>>,
    radius: f64,
    bound: f64,
    frame: Frame,
}

enum Part<'a> {
    Greedy(usize),
    Case(&'a Case),
    Answer,
}

impl Search {
    pub(super) fn new(points: &Opened, options: &Options) -> Result<Self, String> {
        let rows = points.source().len();
        if rows > POINTS_MAX || rows == 0 {
            let (rows, most) = (count(rows), count(POINTS_MAX));
            return Err(format!("the steps are shown for 1 to {most} points, not for {rows}"));
        }
        let k = options.whole("k", K_DEFAULT)?;
        if !(1..=K_MAX).contains(&k) {
            return Err(format!("the steps are shown for 1 to {K_MAX} centers, not for {k}"));
        }
        let k = k as usize;
        let table = Table::of(points, POINTS_MAX)?;
        let source = points.source();
        let greedy = farthest_first(source, k as u64, &FarthestFirstOptions::default())
            .map_err(|error| points.explain(error))?;
        let asked = CentersOptions {
            epsilon: options.number("epsilon", CentersOptions::default().epsilon)?,
            placement: Placement::Free,
            max_nodes: NODES_MAX,
            ..CentersOptions::default()
        };
        let found = centers(source, k, &asked).map_err(|error| points.explain(error))?;
        let core_set: Vec<usize> =
            found.certificate.core_set.iter().map(|&row| row as usize).collect();
        let bound = found.answer.lower_bound;
        let (cases, remark) = match &found.certificate.proof {
            _ if bound <= 0.0 => (vec![], "Nothing has to be proved."),
            LowerBound::Separated => (
                vec![],
                "More points than balls, no two of which fit in one: nothing has to be searched.",
            ),
            LowerBound::Nogoods { .. } => {
                (vec![], "The proof lists sets that fewer balls do not hold; it has no cases.")
            }
            // Nothing is left out here, so no branch is refuted by what is.
            LowerBound::Branches { items } | LowerBound::Avoiding { items, .. } => {
                match cases(&table, &core_set, items, k, bound)? {
                    None => {
                        (vec![], "The branches of this proof are too near the bound to be shown.")
                    }
                    Some(cases) if cases.len() == CASES_MAX => {
                        (cases, "The proof goes on; its first cases are shown.")
                    }
                    Some(cases) => (cases, "All cases are refuted."),
                }
            }
        };
        let mut frame = Frame::of(&table);
        let (centers, radius) = (found.answer.centers, found.answer.radius);
        centers.iter().for_each(|center| frame.hold(place(center), radius));
        let greedy_rows = greedy.order.iter().map(|&row| row as usize);
        Ok(Search {
            k,
            greedy: greedy_rows.zip(greedy.radii).collect(),
            next: greedy.next.map(|row| row as usize),
            core_set,
            cases,
            remark,
            centers,
            radius,
            bound,
            frame: frame.padded(0.08),
            table,
        })
    }

    fn part(&self, step: usize) -> Result<Part<'_>, String> {
        let case = step.checked_sub(self.greedy.len());
        match case.map(|case| (case, self.cases.get(case))) {
            None => Ok(Part::Greedy(step)),
            Some((_, Some(case))) => Ok(Part::Case(case)),
            Some((case, None)) if case == self.cases.len() => Ok(Part::Answer),
            Some(_) => Err("there is no such step".to_owned()),
        }
    }
}

impl Trace for Search {
    fn count(&self) -> usize {
        self.greedy.len() + self.cases.len() + 1
    }

    fn words(&self, step: usize) -> Result<Value, String> {
        Ok(match self.part(step)? {
            Part::Greedy(step) => {
                let (row, radius) = self.greedy[step];
                let chosen = counted(step as u64 + 1, "center");
                said(
                    format!("Farthest first: {chosen}"),
                    format!(
                        "Row {} joins. The farthest point is now {} away, so {chosen} of any places need at least half of that.",
                        row + 1,
                        short(radius)
                    ),
                )
            }
            Part::Case(case) => {
                let number = step - self.greedy.len() + 1;
                let rows = counted(case.balls[case.ball].len() as u64, "point");
                let (radius, bound) = (short(case.radius), short(self.bound));
                let end = match case.is_refuted {
                    true => format!("not below the bound {bound}: refuted"),
                    false => format!("below the bound {bound}: the next point is given"),
                };
                said(
                    format!(
                        "Proof, case {} of {}",
                        count(number as u64),
                        count(self.cases.len() as u64)
                    ),
                    format!(
                        "Row {} is given to ball {} of {}. Its {rows} need a radius of {radius}, {end}.",
                        case.row + 1,
                        case.ball + 1,
                        self.k
                    ),
                )
            }
            Part::Answer => said(
                format!("The answer: {}", counted(self.centers.len() as u64, "center")),
                format!(
                    "Radius {}. No {} centers have a radius below {}: a gap of {}. {}",
                    short(self.radius),
                    self.k,
                    short(self.bound),
                    gap(if self.bound > 0.0 { self.radius / self.bound - 1.0 } else { 0.0 }),
                    self.remark
                ),
            ),
        })
    }

    fn figure(&self, step: usize) -> Result<Figure, String> {
        let mut layers = vec![cloud(&self.table, "points")];
        match self.part(step)? {
            Part::Greedy(step) => {
                let rows: Vec<usize> = self.greedy[..=step].iter().map(|&(row, _)| row).collect();
                let next = self.greedy.get(step + 1).map(|&(row, _)| row).or(self.next);
                let radius = self.greedy[step].1;
                let around = rows.iter().map(|&row| (self.table.place(row), radius));
                let around = around.filter(|&(at, radius)| self.frame.holds(at, radius));
                layers.extend([
                    circles(
                        "as far as the farthest point",
                        Tone::Answer,
                        LineStyle::Dashed,
                        around,
                    ),
                    marked(&self.table, &rows, "chosen", Tone::Support, 4.5),
                    marked(&self.table, next.as_slice(), "farthest", Tone::Second, 5.0),
                ]);
            }
            Part::Case(case) => {
                layers.push(marked(&self.table, &self.core_set, "core-set", Tone::Ink, 2.6));
                for (number, rows) in case.balls.iter().enumerate() {
                    let tone = TONES[number % TONES.len()];
                    let (center, radius) = ball_of(&self.table, rows)?;
                    let ball = [(place(&center), radius)];
                    let ball =
                        ball.into_iter().filter(|&(at, radius)| self.frame.holds(at, radius));
                    let name = format!("ball {}", number + 1);
                    let is_refuted = case.is_refuted && number == case.ball;
                    let style = if is_refuted { LineStyle::Dashed } else { LineStyle::Filled };
                    layers.push(circles("", tone, style, ball));
                    layers.push(marked(&self.table, rows, &name, tone, 4.2));
                }
                layers.push(marked(&self.table, &[case.row], "given now", Tone::Support, 6.0));
            }
            Part::Answer => {
                let balls = self.centers.iter().map(|center| (place(center), self.radius));
                layers.extend([
                    circles("balls", Tone::Answer, LineStyle::Filled, balls),
                    marked(&self.table, &self.core_set, "core-set", Tone::Support, 3.6),
                ]);
            }
        }
        let caption = match self.table.dim {
            0..=2 => String::new(),
            dim => format!("A shadow: the first two of {dim} coordinates."),
        };
        Ok(self.frame.figure(&self.table, String::new(), caption, layers))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples;

    #[test]
    fn the_cases_of_the_proof_are_those_of_its_log() {
        let points = samples::generate("few").unwrap();
        let of = |k: u64| {
            let options = Options::parse(&format!(r#"{{"k":{k}}}"#)).unwrap();
            Search::new(&points, &options).unwrap()
        };
        // For some numbers of centers, points that are far apart are proof enough.
        let search = (2..=8).map(of).find(|search| !search.cases.is_empty());
        let search = search.expect("a number of centers whose bound takes a search");
        assert_eq!(search.greedy.len(), search.k);
        assert_eq!(search.remark, "All cases are refuted.");
        for case in &search.cases {
            let (_, radius) = ball_of(&search.table, &case.balls[case.ball]).unwrap();
            assert_eq!(radius, case.radius);
            assert!(case.balls.len() <= search.k && case.balls[case.ball].contains(&case.row));
        }
        // Below each case that is not refuted others follow: the last is refuted.
        assert!(search.cases.last().unwrap().is_refuted);
        for step in 0..search.count() {
            search.words(step).unwrap();
            search.figure(step).unwrap();
        }
        assert!(search.words(search.count()).is_err());
    }
}
