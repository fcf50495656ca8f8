//! Answers of the solver, damaged: the checker refuses every one that claims or proves what is not so.
//!
//! Some changes leave a claim true, and such a certificate may pass: another point of the core-set, another k. They count as damage only
//! where k centers are at hand that show that the claim is false.

use std::collections::BTreeMap;

use taut_certify::{Centers, CheckError, Items, LowerBound, Placement, Solution};
use taut_enclose::{CentersMethod, CentersOptions};
use taut_points::{Distribution, Points, generate};

/// An answer, and what it was found for.
#[derive(Clone)]
struct Sound {
    name: &'static str,
    values: Vec<f64>,
    columns: usize,
    options: CentersOptions<'static>,
    found: Solution<Centers>,
}

/// The rows of a task: points of the plane if not said otherwise, with a last column for radii or weights.
struct Task {
    name: &'static str,
    n: usize,
    dim: usize,
    items: Items,
    k: usize,
    options: CentersOptions<'static>,
}

fn solve(
    values: &[f64],
    columns: usize,
    items: Items,
    k: usize,
    options: &CentersOptions<'_>,
) -> Option<Solution<Centers>> {
    let points = Points::new(values, columns).ok()?;
    taut_enclose::centers(&points, k, &CentersOptions { inputs: items, ..*options }).ok()
}

fn sound(seed: u64) -> Vec<Sound> {
    let plain = CentersOptions { epsilon: 1e-9, assignment: true, ..Default::default() };
    let rows = CentersOptions { placement: Placement::Rows, ..plain };
    let weights = CentersOptions { weights: true, ..plain };
    let out = |outliers, options| CentersOptions { outliers, ..options };
    let by = |method, options| CentersOptions { method, ..options };
    let (thesis, traversal) = (CentersMethod::Thesis, CentersMethod::FarthestFirst);
    let coarse = CentersOptions { epsilon: 0.1, ..plain };
    let task = |name, n, k, options| Task { name, n, dim: 2, items: Items::Points, k, options };
    let tasks = [
        task("free, few", 60, 4, plain),
        task("free, coarse", 60, 4, coarse),
        task("free, branches", 60, 9, plain),
        task("free, some left out", 40, 3, out(2, plain)),
        task("free, branches, some left out", 50, 9, out(1, plain)),
        Task { dim: 3, ..task("free, in space", 40, 3, plain) },
        task("free, two apart", 3, 2, plain),
        task("thesis", 40, 3, by(thesis, plain)),
        task("farthest first", 80, 5, by(traversal, plain)),
        Task { items: Items::Balls, ..task("balls", 40, 3, plain) },
        Task { items: Items::Balls, ..task("balls, some left out", 30, 2, out(1, plain)) },
        task("weights", 40, 3, weights),
        task("weights, some left out", 30, 2, out(1, weights)),
        task("rows", 60, 4, rows),
        task("rows, many", 80, 12, rows),
        task("rows, some left out", 40, 3, out(2, rows)),
        task("rows, weights", 30, 3, CentersOptions { placement: Placement::Rows, ..weights }),
        task("rows, farthest first", 60, 5, by(traversal, rows)),
    ];
    let found = |Task { name, n, dim, items, k, options }: Task| {
        let columns = dim + usize::from(items == Items::Balls || options.weights);
        let mut values: Vec<f64> = generate(Distribution::Uniform, n, columns, seed).unwrap();
        if columns > dim {
            let last = values.iter_mut().skip(dim).step_by(columns);
            last.for_each(|v| *v = 0.05 + 0.2 * v.abs());
        }
        let found = solve(&values, columns, items, k, &options).unwrap();
        Sound { name, values, columns, options, found }
    };
    tasks.into_iter().map(found).collect()
}

impl Sound {
    fn check(&self) -> Result<(), CheckError> {
        let points = Points::new(&self.values, self.columns).unwrap();
        self.found.check(&points).map(|_| ())
    }

    fn len(&self) -> usize {
        self.values.len() / self.columns
    }

    fn row(&self, row: u64) -> &[f64] {
        &self.values[row as usize * self.columns..][..self.columns]
    }

    fn reach(&self, row: &[f64], center: &[f64]) -> f64 {
        let d = row.iter().zip(center).map(|(x, c)| (x - c).powi(2)).sum::<f64>().sqrt();
        match self.found.certificate.items {
            Items::Balls => d + row[row.len() - 1],
            _ if self.options.weights => d * row[row.len() - 1],
            _ => d,
        }
    }

    /// Returns true if some row that counts is clearly outside.
    fn is_outside(&self) -> bool {
        let answer = &self.found.answer;
        (0..self.len() as u64).filter(|row| !answer.outliers.contains(row)).any(|row| {
            let reaches = answer.centers.iter().map(|c| self.reach(self.row(row), c));
            reaches.fold(f64::INFINITY, f64::min) > answer.radius * (1.0 + 1e-12)
        })
    }

    /// Returns true if k centers smaller than the lower bound are known that hold these rows but z: then nothing can prove it by these rows.
    fn is_false(&self, core_set: &[u64], k: usize, z: u64) -> bool {
        if core_set.len() as u64 <= z {
            return true;
        }
        if self.options.placement == Placement::Rows {
            return self.is_false_of_rows(core_set, k, z);
        }
        let few: Vec<f64> = core_set.iter().flat_map(|&row| self.row(row)).copied().collect();
        let method = CentersMethod::Tree;
        let options = CentersOptions { outliers: z, method, max_nodes: 3000, ..self.options };
        let items = self.found.certificate.items;
        let Some(found) = solve(&few, self.columns, items, k, &options) else { return false };
        let nearest = |row: &[f64]| {
            let reaches = found.answer.centers.iter().map(|c| self.reach(row, c));
            reaches.fold(f64::INFINITY, f64::min)
        };
        let mut reaches: Vec<f64> = few.chunks_exact(self.columns).map(nearest).collect();
        reaches.sort_unstable_by(f64::total_cmp);
        reaches[reaches.len() - 1 - z as usize] < self.found.answer.lower_bound * (1.0 - 1e-7)
    }

    /// The same for centers among all rows, which are taken greedily: each next one holds the most of what is left.
    fn is_false_of_rows(&self, core_set: &[u64], k: usize, z: u64) -> bool {
        let least = self.found.answer.lower_bound * (1.0 - 1e-7);
        let dim = self.columns - usize::from(self.options.weights);
        let mut left = core_set.to_vec();
        for _ in 0..k {
            let rest = |center: u64| {
                let center = &self.row(center)[..dim];
                let rows = left.iter().copied();
                rows.filter(|&row| self.reach(self.row(row), center) >= least).collect::<Vec<_>>()
            };
            let Some(best) = (0..self.len() as u64).map(rest).min_by_key(Vec::len) else { break };
            left = best;
        }
        left.len() as u64 <= z
    }
}

/// Takes copies of a sound answer and changes them.
struct Damage<'a> {
    sound: &'a Sound,
    made: Vec<(&'static str, Sound)>,
}

impl Damage<'_> {
    fn to(&mut self, kind: &'static str, change: impl FnOnce(&mut Sound)) {
        let mut damaged = self.sound.clone();
        change(&mut damaged);
        self.made.push((kind, damaged));
    }

    /// The same where the change puts some row outside.
    fn if_outside(&mut self, kind: &'static str, change: impl FnOnce(&mut Sound)) {
        let mut damaged = self.sound.clone();
        change(&mut damaged);
        if damaged.is_outside() {
            self.made.push((kind, damaged));
        }
    }
}

fn damaged(sound: &Sound) -> Vec<(&'static str, Sound)> {
    let mut damage = Damage { sound, made: vec![] };
    numbers(&mut damage);
    question(&mut damage);
    centers(&mut damage);
    lists(&mut damage);
    core_set(&mut damage);
    branches(&mut damage);
    input(&mut damage);
    damage.made
}

fn numbers(damage: &mut Damage<'_>) {
    let Centers { radius, lower_bound, .. } = damage.sound.found.answer;
    for value in [radius * (1.0 - 1e-9), radius / 2.0, 0.0, -radius, f64::NAN, f64::INFINITY] {
        damage.to("radius lowered, or no number", |s| s.found.answer.radius = value);
    }
    damage.to("radius beyond the gap", |s| s.found.answer.radius *= 1.0 + 1e-6);
    // Above the radius that was reached, and the radius with it, so that nothing but the proof can tell.
    for factor in [1.0 + 1e-7, 1.01, 2.0] {
        damage.to("bound and radius raised", |s| {
            s.found.answer.lower_bound = radius * factor;
            s.found.answer.radius = radius * factor * 1.5;
            s.found.certificate.gap = 0.6;
        });
        damage.to("bound above the radius", |s| s.found.answer.lower_bound = radius * factor);
    }
    for value in [lower_bound * (1.0 - 1e-6), lower_bound / 2.0, 0.0, -lower_bound, f64::NAN] {
        damage.to("bound lowered, or no number", |s| s.found.answer.lower_bound = value);
    }
    let gap = damage.sound.found.certificate.gap;
    for value in [gap * 0.999 - 1e-14, -1.0, f64::NAN, f64::INFINITY] {
        damage.to("gap lowered, or no number", |s| s.found.certificate.gap = value);
    }
}

/// Fewer centers and points left out than there are, and more of them than the core-set proves anything for.
fn question(damage: &mut Damage<'_>) {
    let found = &damage.sound.found;
    let (k, z) = (found.certificate.k, found.certificate.outliers);
    let core_set = &found.certificate.core_set;
    for other in 0..found.answer.centers.len() as u64 {
        damage.to("k lowered", |s| s.found.certificate.k = other);
    }
    for other in [k + 1, k + 2, 2 * k] {
        if damage.sound.is_false(core_set, other as usize, z) {
            damage.to("k raised", |s| s.found.certificate.k = other);
        }
    }
    damage.to("k huge", |s| s.found.certificate.k = u64::MAX);
    for other in 0..found.answer.outliers.len() as u64 {
        damage.to("outliers lowered", |s| s.found.certificate.outliers = other);
    }
    for other in [z + 1, z + 3] {
        if damage.sound.is_false(core_set, k as usize, other) {
            damage.to("outliers raised", |s| s.found.certificate.outliers = other);
        }
    }
    damage.to("outliers huge", |s| s.found.certificate.outliers = u64::MAX);
    damage.to("placement changed", |s| {
        let placement = &mut s.found.certificate.placement;
        *placement = match *placement {
            Placement::Free => Placement::Rows,
            Placement::Rows => Placement::Free,
        };
    });
    damage.to("weights or not", |s| s.found.certificate.weights ^= true);
    damage.to("other items", |s| {
        let items = &mut s.found.certificate.items;
        *items = if *items == Items::Points { Items::Balls } else { Items::Points };
    });
}

fn centers(damage: &mut Damage<'_>) {
    let answer = &damage.sound.found.answer;
    let (count, dim) = (answer.centers.len(), answer.centers[0].len());
    for center in 0..count {
        for column in 0..dim {
            for step in [-1.0, -1e-6, 1e-6, 1.0] {
                let moved = |s: &mut Sound| s.found.answer.centers[center][column] += step;
                match damage.sound.options.placement {
                    Placement::Free => damage.if_outside("center moved", moved),
                    Placement::Rows => damage.to("center moved from its row", moved),
                }
            }
            damage.to("center not finite", |s| {
                s.found.answer.centers[center][column] = f64::NAN;
            });
        }
        damage.if_outside("center dropped", |s| {
            s.found.answer.centers.remove(center);
            if !s.found.answer.rows.is_empty() {
                s.found.answer.rows.remove(center);
            }
            s.found.answer.assignment.clear();
        });
        damage.to("center too short", |s| _ = s.found.answer.centers[center].pop());
    }
    for position in 0..answer.rows.len() {
        let n = damage.sound.len() as u64;
        for row in [(answer.rows[position] + 1) % n, n, u64::MAX] {
            damage.to("row of a center", |s| s.found.answer.rows[position] = row);
        }
    }
    damage.to("no centers", |s| s.found.answer.centers.clear());
}

fn lists(damage: &mut Damage<'_>) {
    let (answer, n) = (&damage.sound.found.answer, damage.sound.len() as u64);
    for (position, &row) in answer.outliers.iter().enumerate() {
        damage.if_outside("left out no more", |s| _ = s.found.answer.outliers.remove(position));
        damage.to("left out twice", |s| s.found.answer.outliers.insert(position, row));
        damage.to("left out, and not there", |s| s.found.answer.outliers[position] = n);
    }
    damage.to("too many left out", |s| {
        s.found.answer.outliers = (0..=s.found.certificate.outliers).collect();
    });
    for row in 0..n {
        let named = answer.assignment[row as usize];
        let reach = |c: usize| damage.sound.reach(damage.sound.row(row), &answer.centers[c]);
        let farther =
            (0..answer.centers.len()).find(|&c| reach(c) > reach(named as usize) * (1.0 + 1e-9));
        for other in [farther.map(|c| c as u32), Some(u32::MAX)].into_iter().flatten() {
            damage.to("assigned to another", |s| {
                s.found.answer.assignment[row as usize] = other;
            });
        }
    }
    damage.to("assignment cut", |s| _ = s.found.answer.assignment.pop());
}

fn core_set(damage: &mut Damage<'_>) {
    let found = &damage.sound.found;
    let (k, z) = (found.certificate.k as usize, found.certificate.outliers);
    let (n, rows) = (damage.sound.len() as u64, found.certificate.core_set.clone());
    for position in 0..rows.len() {
        let mut fewer = rows.clone();
        fewer.remove(position);
        if damage.sound.is_false(&fewer, k, z) {
            damage.to("core-set entry dropped", |s| s.found.certificate.core_set = fewer);
        }
        for other in [(rows[position] + 1) % n, (rows[position] + n / 2) % n] {
            let mut changed = rows.clone();
            changed[position] = other;
            if !rows.contains(&other) && damage.sound.is_false(&changed, k, z) {
                damage.to("core-set entry changed", |s| s.found.certificate.core_set = changed);
            }
        }
        for (kind, other) in [
            ("core-set entry twice", rows[(position + 1) % rows.len()]),
            ("core-set entry not there", n),
        ] {
            damage.to(kind, |s| s.found.certificate.core_set[position] = other);
        }
        damage.to("core-set entry repeated", |s| {
            s.found.certificate.core_set.push(rows[position]);
        });
    }
    for length in 0..rows.len() / 2 {
        if damage.sound.is_false(&rows[..length], k, z) {
            damage.to("core-set cut", |s| s.found.certificate.core_set.truncate(length));
        }
    }
}

/// All of these are refused, true or not: a log that ends early or late, or gives what is given, is none.
fn branches(damage: &mut Damage<'_>) {
    let LowerBound::Branches { items } = &damage.sound.found.certificate.proof else { return };
    let with = |s: &mut Sound, items| s.found.certificate.proof = LowerBound::Branches { items };
    let count = damage.sound.found.certificate.core_set.len() as u32;
    for at in (0..items.len()).step_by(items.len().div_ceil(50)) {
        damage.to("log cut", |s| with(s, items[..at].to_vec()));
        let mut changed = items.clone();
        changed[at] = count;
        damage.to("log with an item that is not there", |s| with(s, changed));
        if at > 0 {
            let mut changed = items.clone();
            changed[at] = items[0];
            damage.to("log with an item given before", |s| with(s, changed));
        }
    }
    damage.to("log too long", |s| with(s, [&items[..], &[0]].concat()));
    damage.to("log without its first", |s| with(s, items[1..].to_vec()));
}

fn input(damage: &mut Damage<'_>) {
    for bit in 0..64 {
        damage.to("bit of the hash", |s| s.found.certificate.points_hash.0 ^= 1 << bit);
    }
    for at in 0..damage.sound.values.len() {
        damage.to("coordinate of the input", |s| s.values[at] = s.values[at].next_up());
    }
    damage.to("row of the input removed", |s| s.values.truncate(s.values.len() - s.columns));
}

#[test]
fn every_damaged_answer_is_refused() {
    let mut kinds = BTreeMap::<&str, usize>::new();
    let mut proofs = BTreeMap::<&str, usize>::new();
    for &seed in crate::test_length::long_or(&[1, 2][..], &[1]) {
        for sound in sound(seed) {
            sound.check().unwrap_or_else(|why| panic!("{}: {why}", sound.name));
            *proofs.entry(name_of(&sound.found.certificate.proof)).or_default() += 1;
            for (kind, damaged) in damaged(&sound) {
                match damaged.check() {
                    Err(CheckError::Rejected(_)) => *kinds.entry(kind).or_default() += 1,
                    other => panic!("{}, {kind}: {other:?}\n{:?}", sound.name, damaged.found),
                }
            }
        }
    }
    let count: usize = kinds.values().sum();
    println!("{count} damaged answers of {} kinds, all refused; proofs {proofs:?}", kinds.len());
    kinds.iter().for_each(|(kind, count)| println!("{count:>6} {kind}"));
    assert!(
        count >= crate::test_length::long_or(1000, 500) && proofs.len() >= 2,
        "{count}, {proofs:?}"
    );
}

fn name_of(proof: &LowerBound) -> &'static str {
    match proof {
        LowerBound::Separated => "apart",
        LowerBound::Branches { .. } => "branches",
        LowerBound::Avoiding { .. } => "avoiding",
        LowerBound::Nogoods { .. } => "nogoods",
    }
}
