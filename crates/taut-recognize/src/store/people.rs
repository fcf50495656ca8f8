//! People: enrolling, verifying, identifying, listing, deleting.

use super::file::{self, each_person, find_person};
use super::record::{self, Row, check_name};
use super::seal::{Kind, Place};
use super::{Scan, Store, StoreError};
use crate::hand::Side;
use crate::template::{Index, Template};

/// A decision about one claim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verification {
    /// Whether the scan is accepted as one of the person.
    pub is_accepted: bool,
    /// Failed verifications that are left before the person is locked.
    pub attempts_left: u32,
    /// The distance, which is at most the threshold of the matcher where the scan is accepted. Whoever can try scans and sees distances
    /// can improve a forged hand step by step: show them to nobody who can.
    pub distance: f64,
}

/// The enrolled person who is nearest to a scan.
#[derive(Clone, Debug, PartialEq)]
pub struct Identification {
    /// The number of the person.
    pub number: i64,
    /// The name.
    pub name: String,
    /// The distance; see [`Verification::distance`].
    pub distance: f64,
}

/// What a list says of a person.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Person {
    /// A number that no other person of the store has or had.
    pub number: i64,
    /// The name.
    pub name: String,
    /// Which hand is enrolled.
    pub side: Side,
    /// Scans of the template.
    pub scans: u32,
    /// Failed verifications since the last one that was accepted.
    pub failures: u32,
    /// Whether verification is refused until [`Store::unlock`].
    pub is_locked: bool,
}

/// The templates of one hand of all people who are not locked, decrypted for searching.
#[derive(Clone, Debug)]
pub struct PeopleIndex {
    index: Index,
    /// The number of the person of each template.
    people: Vec<i64>,
    side: Side,
    /// The number of the store.
    store: [u8; 16],
}

impl PeopleIndex {
    /// The number of people in it.
    pub fn len(&self) -> usize {
        self.people.len()
    }

    /// Whether there is nobody.
    pub fn is_empty(&self) -> bool {
        self.people.is_empty()
    }
}

impl Store {
    /// Enrolls a person with scans of one hand, at least as many as those with which the error rates of the matcher were measured.
    /// Returns the number of the person.
    ///
    /// # Errors
    /// [`StoreError::Name`], [`StoreError::NameTaken`], [`StoreError::TwoHands`], [`StoreError::ScansDiffer`],
    /// [`StoreError::TooFewScans`], [`StoreError::SameScan`], and
    /// [`StoreError::Recognize`] for no scans, too many, or features that the matcher does not take.
    pub fn enroll(&mut self, name: &str, scans: &[Scan]) -> Result<i64, StoreError> {
        check_name(name)?;
        let lookup = self.secrets.lookup(name);
        if find_person(&self.connection, &lookup)?.is_some() {
            return Err(StoreError::NameTaken);
        }
        let map = |scan: &Scan| self.matcher.map(&scan.features);
        let mapped = scans.iter().map(map).collect::<Result<Vec<_>, _>>()?;
        let template = Template::of_mapped(&mapped)?;
        let side = scans[0].side;
        if let Some(place) = scans.iter().position(|scan| scan.side != side) {
            return Err(StoreError::TwoHands { scan: place + 1 });
        }
        let needed = self.matcher.rates().enrolled;
        if (scans.len() as u64) < needed {
            return Err(StoreError::TooFewScans { found: scans.len(), needed });
        }
        let is_repeated = |place: &usize| scans[..*place].contains(&scans[*place]);
        if let Some(place) = (1..scans.len()).find(is_repeated) {
            return Err(StoreError::SameScan { scan: place + 1 });
        }
        if let Some(place) = self.outlier(&mapped)? {
            return Err(StoreError::ScansDiffer { scan: place + 1 });
        }
        // Counters only grow, so no other person has or had this number.
        let person = self.manifest.counter as i64 + 1;
        let at = |kind| Place { kind, person, lookup };
        let row = Row {
            lookup,
            name: self.secrets.seal(at(Kind::Name), &record::name_text(name))?,
            template: self
                .secrets
                .seal(at(Kind::Template), &record::template_text(side, &template))?,
            attempts: self.secrets.seal(at(Kind::Attempts), &0u32.to_le_bytes())?,
        };
        self.put(person, Some(&row))?;
        Ok(person)
    }

    /// The scan that is farthest from the template of the others, if it is not accepted by that.
    fn outlier(&self, mapped: &[Vec<f64>]) -> Result<Option<usize>, StoreError> {
        let mut worst = (self.matcher.threshold(), None);
        for place in 0..mapped.len() {
            let others: Vec<Vec<f64>> = mapped
                .iter()
                .enumerate()
                .filter(|other| other.0 != place)
                .map(|o| o.1.clone())
                .collect();
            if others.is_empty() {
                break;
            }
            let distance = Template::of_mapped(&others)?.distance(&mapped[place])?;
            if distance > worst.0 {
                worst = (distance, Some(place));
            }
        }
        Ok(worst.1)
    }

    /// Decides whether a scan is one of the person of this name.
    ///
    /// The attempt is counted in the file before the scan is compared, and the count is cleared after an accepted one: a process that is
    /// stopped in between has no free attempts.
    ///
    /// # Errors
    /// [`StoreError::UnknownPerson`], [`StoreError::Locked`], [`StoreError::OtherHand`], and [`StoreError::Recognize`] for features that
    /// the matcher does not take.
    pub fn verify(&mut self, name: &str, scan: &Scan) -> Result<Verification, StoreError> {
        let (person, mut row) = self.find(name)?;
        let failures = self.failures(person, &row)?;
        if failures >= self.failures_max {
            return Err(StoreError::Locked { failures });
        }
        let (side, template) = self.template(person, &row)?;
        if side != scan.side {
            return Err(StoreError::OtherHand { found: scan.side });
        }
        let mapped = self.matcher.map(&scan.features)?;
        self.set_failures(person, &mut row, failures + 1)?;
        let distance = template.distance(&mapped)?;
        let is_accepted = distance <= self.matcher.threshold();
        if is_accepted {
            self.set_failures(person, &mut row, 0)?;
        }
        let failures = if is_accepted { 0 } else { failures + 1 };
        Ok(Verification { is_accepted, attempts_left: self.failures_max - failures, distance })
    }

    /// Decrypts the templates of one hand for searching. Locked people are left out.
    ///
    /// # Errors
    /// [`StoreError::Tampered`] and [`StoreError::Damaged`].
    pub fn index(&self, side: Side) -> Result<PeopleIndex, StoreError> {
        let (mut means, mut scans, mut people) = (vec![], vec![], vec![]);
        each_person(&self.connection, |person, row| {
            self.check(person, &row)?;
            let (own, template) = self.template(person, &row)?;
            if own == side && self.failures(person, &row)? < self.failures_max {
                means.extend_from_slice(template.mean());
                scans.push(template.scans());
                people.push(person);
            }
            Ok(())
        })?;
        let index = Index::from_parts(means, scans, self.matcher.dim())?;
        Ok(PeopleIndex { index, people, side, store: self.secrets.store() })
    }

    /// Finds the person of the index who is nearest to a scan; none where that one is not accepted.
    ///
    /// Nothing is counted, so that this must not be open to whoever likes to try. Among n people the rate of false matches is up to n
    /// times that of a verification.
    ///
    /// # Errors
    /// [`StoreError::OtherHand`] where the index is that of the other hand, [`StoreError::OldIndex`] where it is that of another store,
    /// or the person was deleted or locked after it was made, and [`StoreError::Recognize`] for features that the matcher does not take.
    pub fn identify(
        &self,
        index: &PeopleIndex,
        scan: &Scan,
    ) -> Result<Option<Identification>, StoreError> {
        if index.side != scan.side {
            return Err(StoreError::OtherHand { found: scan.side });
        }
        if index.store != self.secrets.store() {
            return Err(StoreError::OldIndex);
        }
        let mapped = self.matcher.map(&scan.features)?;
        let Some(nearest) = index.index.nearest(&mapped, self.matcher.threshold())? else {
            return Ok(None);
        };
        let number = index.people[nearest.place];
        let row = file::person(&self.connection, number)?.ok_or(StoreError::OldIndex)?;
        self.check(number, &row)?;
        if self.failures(number, &row)? >= self.failures_max {
            return Err(StoreError::OldIndex);
        }
        let name = self.name(number, &row)?;
        Ok(Some(Identification { number, name, distance: nearest.distance }))
    }

    /// All people, in the order in which they were enrolled.
    ///
    /// # Errors
    /// [`StoreError::Tampered`] and [`StoreError::Damaged`].
    pub fn people(&self) -> Result<Vec<Person>, StoreError> {
        let mut people = vec![];
        each_person(&self.connection, |number, row| {
            self.check(number, &row)?;
            let (side, template) = self.template(number, &row)?;
            let failures = self.failures(number, &row)?;
            people.push(Person {
                number,
                name: self.name(number, &row)?,
                side,
                scans: template.scans(),
                failures,
                is_locked: failures >= self.failures_max,
            });
            Ok(())
        })?;
        Ok(people)
    }

    /// Deletes a person: the records are overwritten, and the file is compacted.
    ///
    /// # Errors
    /// [`StoreError::UnknownPerson`], [`StoreError::Damaged`], and [`StoreError::NotCompacted`] after the deletion.
    pub fn delete(&mut self, name: &str) -> Result<(), StoreError> {
        let (person, _) = self.find(name)?;
        self.put(person, None)?;
        file::compact(&self.connection, &self.path)
    }

    /// Clears the failed verifications of a person.
    ///
    /// # Errors
    /// [`StoreError::UnknownPerson`].
    pub fn unlock(&mut self, name: &str) -> Result<(), StoreError> {
        let (person, mut row) = self.find(name)?;
        self.set_failures(person, &mut row, 0)
    }

    fn find(&self, name: &str) -> Result<(i64, Row), StoreError> {
        let lookup = self.secrets.lookup(name);
        let found = find_person(&self.connection, &lookup)?;
        let (person, row) = found.ok_or(StoreError::UnknownPerson)?;
        self.check(person, &row)?;
        Ok((person, row))
    }

    /// Refuses records that are not those of the manifest: another process that ignores the lock may have written them since the store
    /// was opened.
    fn check(&self, person: i64, row: &Row) -> Result<(), StoreError> {
        match self.digests.people.get(&person) == Some(&row.digest(&self.secrets, person)) {
            true => Ok(()),
            false => Err(tampered("a record", person)),
        }
    }

    fn set_failures(
        &mut self,
        person: i64,
        row: &mut Row,
        failures: u32,
    ) -> Result<(), StoreError> {
        let place = Place { kind: Kind::Attempts, person, lookup: row.lookup };
        row.attempts = self.secrets.seal(place, &failures.to_le_bytes())?;
        self.put(person, Some(row))
    }

    fn failures(&self, person: i64, row: &Row) -> Result<u32, StoreError> {
        let place = Place { kind: Kind::Attempts, person, lookup: row.lookup };
        let opened = self.secrets.open(place, &row.attempts);
        let bytes = opened.and_then(|text| <[u8; 4]>::try_from(text.as_slice()).ok());
        bytes.map(u32::from_le_bytes).ok_or_else(|| tampered("the count of failures", person))
    }

    fn template(&self, person: i64, row: &Row) -> Result<(Side, Template), StoreError> {
        let place = Place { kind: Kind::Template, person, lookup: row.lookup };
        let opened = self.secrets.open(place, &row.template);
        let found = opened.and_then(|text| record::read_template(&text));
        let found = found.filter(|found| found.1.mean().len() == self.matcher.dim());
        found.ok_or_else(|| tampered("the template", person))
    }

    fn name(&self, person: i64, row: &Row) -> Result<String, StoreError> {
        let place = Place { kind: Kind::Name, person, lookup: row.lookup };
        let opened = self.secrets.open(place, &row.name);
        let name = opened.and_then(|text| record::read_name(&text));
        name.ok_or_else(|| tampered("the name", person))
    }
}

fn tampered(what: &str, person: i64) -> StoreError {
    StoreError::Tampered { record: format!("{what} of person number {person}") }
}
