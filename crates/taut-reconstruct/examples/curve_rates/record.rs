//! What became of draws, and the table of a section.

use super::HELD_BACK;

/// One drawn input and what was found.
#[derive(Clone, Debug)]
pub(crate) struct Draw {
    /// The class, and the option of the class if it has any.
    pub(crate) class: String,
    /// The seed within the class.
    pub(crate) seed: u64,
    /// Whether the goals are about it.
    pub(crate) is_fair: bool,
    /// Whether it is dense enough to be certified.
    pub(crate) is_dense: bool,
    /// Whether the answer is what the class asks for.
    pub(crate) is_right: bool,
    /// Whether the answer is certified.
    pub(crate) is_certified: bool,
    /// The least share of right answers that is asked of the class.
    pub(crate) asked: Option<f64>,
    /// What may help to see why an answer is as it is.
    pub(crate) note: String,
}

impl Draw {
    /// A draw of a class that is right or wrong.
    pub(crate) fn of(class: impl Into<String>, seed: u64, is_right: bool) -> Self {
        Self {
            class: class.into(),
            seed,
            is_fair: true,
            is_dense: false,
            is_right,
            is_certified: false,
            asked: None,
            note: String::new(),
        }
    }

    /// The same, of a class of which a share must be right.
    pub(crate) fn asked(self, share: f64) -> Self {
        Self { asked: Some(share), ..self }
    }

    /// The same with a note.
    pub(crate) fn noted(self, note: String) -> Self {
        Self { note, ..self }
    }

    /// Whether it is of the held-back half.
    pub(crate) fn is_held_back(&self) -> bool {
        self.seed >= HELD_BACK
    }
}

/// The classes in the order of their first draws.
pub(crate) fn classes(draws: &[Draw]) -> Vec<&str> {
    let mut classes: Vec<&str> = vec![];
    for draw in draws {
        if !classes.contains(&draw.class.as_str()) {
            classes.push(&draw.class);
        }
    }
    classes
}

/// How many of the draws of a half are right, and how many there are.
pub(crate) fn share(draws: &[&Draw], is_held_back: bool) -> [usize; 2] {
    let half = || draws.iter().filter(|draw| draw.is_held_back() == is_held_back);
    [half().filter(|draw| draw.is_right).count(), half().count()]
}

/// Prints the rates of each class: both halves, and whether the held-back one is as asked.
pub(crate) fn print(draws: &[Draw]) {
    println!("class | tuning half | held-back half | asked | as asked");
    for class in classes(draws) {
        let of: Vec<&Draw> = draws.iter().filter(|draw| draw.class == class).collect();
        let [tuning, held] = [false, true].map(|half| share(&of, half));
        let ratio = |[right, all]: [usize; 2]| format!("{right}/{all}");
        let (asked, verdict) = match of[0].asked {
            Some(asked) => {
                let is_met = held[0] as f64 >= asked * held[1] as f64 - 1e-9;
                (format!("{:.0} %", 100.0 * asked), if is_met { "yes" } else { "NO" })
            }
            None => ("–".to_owned(), "–"),
        };
        println!("{class} | {} | {} | {asked} | {verdict}", ratio(tuning), ratio(held));
        for draw in of.iter().filter(|draw| !draw.is_right && !draw.is_held_back()) {
            if !draw.note.is_empty() {
                eprintln!("  {class} {}: {}", draw.seed, draw.note);
            }
        }
    }
}
