//! Seeded inputs of every kind of answer, with the documents that the solvers make of them.

pub mod ball;
pub mod bodies;
pub mod centers;
pub mod circle;
pub mod clouds;
pub mod convex;
pub mod curve;
pub mod dop;
pub mod ellipse;
pub mod ellipsoid;
pub mod files;
pub mod hand;
pub mod inscribed;
pub mod kernel_ball;
pub mod order;
pub mod oriented;
pub mod rectangle;
pub mod robust;
pub mod surface;
pub mod triangle;
pub mod triangulation;

use serde_json::Value;
use taut::certify::Answer;
use taut::certify::CheckError;
use taut::points::hash_points;
use taut::{AnySolution, Monitor, PointSource, Points, Solution, certify::AnyVerdict};

use crate::test_length::long_or;

/// Most cells of a certificate, so that thousands of forgeries of it are soon checked.
const CELLS_MAX: u64 = 500;

/// Rows of one input.
#[derive(Clone, Debug)]
pub struct Input {
    /// Which input it is, for people to read.
    pub name: String,
    /// All rows, one behind the other; of an input in single precision exact copies of its numbers.
    pub values: Vec<f64>,
    /// Numbers in a row.
    pub columns: usize,
    /// True if the rows are in single precision.
    pub is_single: bool,
}

impl Input {
    /// Rows of double precision.
    pub fn new(name: impl Into<String>, values: Vec<f64>, columns: usize) -> Self {
        Input { name: name.into(), values, columns, is_single: false }
    }

    /// The same rows rounded to single precision.
    pub fn single(&self) -> Self {
        let values = self.values.iter().map(|&x| f64::from(x as f32)).collect();
        Input { name: format!("{}, single", self.name), values, is_single: true, ..self.clone() }
    }

    /// Calls `work` with the rows.
    pub fn with<R>(&self, work: impl FnOnce(&dyn PointSource) -> R) -> R {
        if self.is_single {
            let values: Vec<f32> = self.values.iter().map(|&x| x as f32).collect();
            work(&Points::new(&values, self.columns).expect("rows are whole"))
        } else {
            work(&Points::new(&self.values, self.columns).expect("rows are whole"))
        }
    }

    /// Checks an answer over the rows.
    pub fn check(&self, solution: &AnySolution) -> Result<AnyVerdict, CheckError> {
        self.with(|source| solution.check(source, &Monitor::silent()))
    }

    /// The hash of the rows, as documents have it.
    pub fn hash(&self) -> String {
        let hash = self.with(|source| hash_points(source, &Monitor::silent()));
        hash.expect("rows in memory can be read").to_string()
    }
}

/// An input with documents to forge.
pub struct Case {
    /// The rows.
    pub input: Input,
    /// The documents that solvers made of these rows, or somebody by hand: each with a word on how.
    pub own: Vec<(String, Value)>,
    /// The documents that solvers made of other rows, with the hash of these.
    pub foreign: Vec<(String, Value)>,
}

/// The document of a solution.
pub fn document<A: Answer>(solution: &Solution<A>) -> Value {
    serde_json::from_str(&solution.to_json()).expect("a document is JSON")
}

/// The result of a solver for an input in one way: a word on the way, and the document if there is one.
pub type Solved = (String, Option<Value>);

/// Returns all inputs in long tests, else every second one: the first of them or not, as `which` is even or odd.
pub fn some(inputs: Vec<Input>, which: usize) -> Vec<Input> {
    let step = long_or(1, 2);
    inputs.into_iter().skip(which % step).step_by(step).collect()
}

/// Solves each input and relatives of it; documents of relatives and of the neighbors in the list get the hash of the input.
pub fn cases(inputs: Vec<Input>, solve: impl Fn(&Input) -> Vec<Solved>) -> Vec<Case> {
    let solved = |input: &Input| -> Vec<(String, Value)> {
        let ways = solve(input).into_iter();
        ways.filter_map(|(way, document)| Some((way, document?))).collect()
    };
    let own: Vec<Vec<(String, Value)>> = inputs.iter().map(solved).collect();
    let count = inputs.len();
    let mut cases = vec![];
    for (i, input) in inputs.iter().enumerate() {
        let hash = input.hash();
        let mut foreign = vec![];
        for relative in clouds::relatives(input, i as u64).into_iter().step_by(long_or(1, 4)) {
            for (way, document) in solved(&relative) {
                foreign.push((format!("{way} of {}", relative.name), with_hash(document, &hash)));
            }
        }
        for step in 1..4.min(count) {
            let other = (i + step) % count;
            if inputs[other].columns == input.columns {
                for (way, document) in &own[other] {
                    let name = format!("{way} of {}", inputs[other].name);
                    foreign.push((name, with_hash(document.clone(), &hash)));
                }
            }
        }
        if !own[i].is_empty() || !foreign.is_empty() {
            cases.push(Case { input: input.clone(), own: own[i].clone(), foreign });
        }
    }
    cases
}

/// The document with another hash of points wherever one stands.
fn with_hash(mut document: Value, hash: &str) -> Value {
    fn replace(value: &mut Value, hash: &str) {
        match value {
            Value::Object(map) => {
                for (key, value) in map {
                    match key == "points_hash" {
                        true => *value = hash.into(),
                        false => replace(value, hash),
                    }
                }
            }
            Value::Array(list) => list.iter_mut().for_each(|value| replace(value, hash)),
            _ => {}
        }
    }
    replace(&mut document, hash);
    document
}
