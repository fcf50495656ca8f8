//! Tests exactly whether every group of rows that counts lies in one of the balls, and whether the rows are those the certificate
//! speaks of.
//!
//! *Problem.* Rows with one value in the column of groups are a group. For each, some center c with w·|p − c| + r ≤ R for all of
//! its rows; in one pass.
//! *Idea.* A group is held by a set of balls, those that hold each of its rows. A block of rows finds these sets for the groups it
//! has rows of, each of them decided exactly, and blocks are put together by what sets have in common.
//! *Left out.* A group is left out with all its rows or not at all, and groups that are left out are counted.
//! *Assignment.* Where it is given, all rows of a group name one center, from which the group reaches no farther than from any
//! other but for what a sum in `f64` may be off by, (d + 40)u.
//! *Cost.* O(nkd), and k bits for each group, with an assignment k numbers.

use std::cmp::Ordering;
use std::collections::HashMap;

use taut_points::{Cancelled, Monitor, PointSource};

use super::super::{Centers, CentersCertificate, CentersViolation};
use super::core::{Bits, clear, is_set, set};
use super::distance::{Scale, compare};
use super::enclosure::distance;
use super::item::{Item, Layout};
use super::meter::Meter;
use crate::arithmetic::U;
use crate::hashed_pass::{KeptRows, WantedRows, hashed_pass};
use crate::{CheckError, Violation};

/// The balls, ready to be compared with groups of rows.
pub(super) struct GroupEnclosure<'a> {
    answer: &'a Centers,
    layout: Layout,
    scale: Scale,
}

/// The statements about one group, from some of its rows.
struct Seen {
    /// Its value.
    group: f64,
    /// Its first row.
    first: u64,
    is_left_out: bool,
    assigned: Option<u32>,
    /// The balls that hold all of its rows.
    held: Bits,
    /// How far it reaches from each center, for the comparison of centers; empty where nothing is assigned.
    reaches: Vec<f64>,
    /// The first row that is treated otherwise than the first, and how.
    split: Option<(u64, &'static str)>,
}

impl<'a> GroupEnclosure<'a> {
    pub(super) fn of(answer: &'a Centers, layout: Layout) -> Self {
        GroupEnclosure { answer, layout, scale: Scale::of(answer.radius) }
    }

    /// Reads all rows once; returns those of the core-set and those that are centers.
    pub(super) fn check(
        &self,
        source: &dyn PointSource,
        certificate: &CentersCertificate,
        monitor: &Monitor<'_>,
    ) -> Result<KeptRows, CheckError> {
        let wanted = WantedRows::of(certificate.core_set.iter().chain(&self.answer.rows));
        let claimed = certificate.points_hash;
        let (blocks, kept) = hashed_pass(source, claimed, wanted, monitor, |first, rows| {
            let (mut groups, mut row) = (Groups::default(), vec![0.0; source.dim()]);
            let mut meter = Meter::of(monitor);
            for number in 0..rows.len() {
                rows.copy_row(number, &mut row);
                self.row(first + number as u64, &row, &mut groups, &mut meter)?;
            }
            Ok(groups.seen)
        })?;
        let mut groups = Groups::default();
        for seen in blocks.into_iter().flatten() {
            groups.add(seen);
        }
        let mut left_out = 0;
        for seen in &groups.seen {
            self.group(seen)?;
            left_out += usize::from(seen.is_left_out);
        }
        if left_out as u64 > certificate.outliers {
            let most = certificate.outliers;
            return Err(CentersViolation::Outliers { found: left_out, most }.into());
        }
        Ok(kept)
    }

    /// Adds a row to its group.
    fn row(
        &self,
        number: u64,
        row: &[f64],
        groups: &mut Groups,
        meter: &mut Meter<'_>,
    ) -> Result<(), CheckError> {
        if let Some(column) = row.iter().position(|value| !value.is_finite()) {
            return Err(Violation::NonFinite { row: number, column, value: row[column] }.into());
        }
        let of_item = self.layout.of_item(row);
        self.layout.kind.is_valid(number, &of_item)?;
        let group = self.layout.group_of(row).unwrap_or_default();
        let assigned = self.answer.assignment.get(number as usize).copied();
        let centers = self.answer.centers.len();
        if let Some(center) = assigned.filter(|&center| center as usize >= centers) {
            return Err(CentersViolation::NoSuchCenter { row: number, center }.into());
        }
        let seen = groups.seen_of(group, || Seen {
            group,
            first: number,
            is_left_out: self.is_left_out(number),
            assigned,
            held: all(centers),
            reaches: vec![0.0; if assigned.is_some() { centers } else { 0 }],
            split: None,
        });
        seen.compare(number, self.is_left_out(number), assigned);
        let item = self.layout.kind.item(&of_item);
        for center in 0..centers {
            if is_set(&seen.held, center) && !self.holds(&item, center, meter)? {
                clear(&mut seen.held, center);
            }
        }
        meter.spend(seen.reaches.len() * of_item.len())?;
        for (most, center) in seen.reaches.iter_mut().zip(&self.answer.centers) {
            *most = most.max(reach(&item, center));
        }
        Ok(())
    }

    fn is_left_out(&self, row: u64) -> bool {
        self.answer.outliers.binary_search(&row).is_ok()
    }

    /// Tests whether the ball of a center holds an item.
    fn holds(
        &self,
        item: &Item<'_, f64>,
        center: usize,
        meter: &mut Meter<'_>,
    ) -> Result<bool, Cancelled> {
        let rho = [self.answer.radius, -item.radius];
        let place = &self.answer.centers[center];
        let reaches = compare(item.position, place, item.weight, &rho, self.scale, meter)?;
        Ok(reaches != Ordering::Greater)
    }

    /// Judges a group of which all rows were seen.
    fn group(&self, seen: &Seen) -> Result<(), CentersViolation> {
        let Seen { group, first, .. } = *seen;
        if let Some((row, problem)) = seen.split {
            return Err(CentersViolation::GroupSplit { row, first, problem });
        }
        if let Some(center) = seen.assigned {
            let slack = 1.0 + (self.layout.dim + 40) as f64 * U;
            let own = seen.reaches[center as usize];
            let nearer = seen.reaches.iter().position(|reach| reach * slack < own);
            if let Some(nearer) = nearer {
                return Err(CentersViolation::Assignment { row: first, center, nearer });
            }
        }
        match seen.is_left_out || seen.held.iter().any(|&word| word != 0) {
            true => Ok(()),
            false => Err(CentersViolation::GroupOutside {
                row: first,
                group,
                radius: self.answer.radius,
            }),
        }
    }
}

impl Seen {
    /// Compares how a further row is treated with how the first is.
    fn compare(&mut self, row: u64, is_left_out: bool, assigned: Option<u32>) {
        let problem = match () {
            () if self.split.is_some() => return,
            () if is_left_out != self.is_left_out => "but one of the two alone is left out",
            () if assigned != self.assigned => "but is assigned to another center",
            () => return,
        };
        self.split = Some((row, problem));
    }
}

/// Groups in the order of their first rows.
#[derive(Default)]
struct Groups {
    numbers: HashMap<u64, usize>,
    seen: Vec<Seen>,
}

impl Groups {
    fn seen_of(&mut self, group: f64, new: impl FnOnce() -> Seen) -> &mut Seen {
        let number = *self.numbers.entry(group.to_bits()).or_insert(self.seen.len());
        if number == self.seen.len() {
            self.seen.push(new());
        }
        &mut self.seen[number]
    }

    /// Adds what rows after those known say of their group.
    fn add(&mut self, later: Seen) {
        let number = *self.numbers.entry(later.group.to_bits()).or_insert(self.seen.len());
        let Some(known) = self.seen.get_mut(number) else { return self.seen.push(later) };
        known.compare(later.first, later.is_left_out, later.assigned);
        known.split = known.split.or(later.split);
        known.held.iter_mut().zip(&later.held).for_each(|(known, later)| *known &= later);
        let reaches = known.reaches.iter_mut().zip(&later.reaches);
        reaches.for_each(|(known, later)| *known = known.max(*later));
    }
}

/// The set of all of so many balls.
fn all(count: usize) -> Bits {
    let mut bits = vec![0; count.div_ceil(64)];
    (0..count).for_each(|ball| set(&mut bits, ball));
    bits
}

/// w·|p − c| + r, to a few units in the last place.
fn reach(item: &Item<'_, f64>, center: &[f64]) -> f64 {
    item.weight * distance(item.position, center) + item.radius
}
