//! The models.

use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;

use loom::cell::UnsafeCell;
use loom::thread;

use super::{Record, Slot};
use super::atomics::AtomicU32;
use super::held::{Hold, Holder, Owners};
use super::runs::Runs;
use super::slots::{OwnSlots, Room};
use crate::simplex::Simplex;

/// Two cavities that have vertex 1 in common: what lies between them is changed by one thread at a time, and each sees what the
/// other did before it.
#[test]
fn cavities_with_a_vertex_in_common_are_carved_one_after_the_other() {
    loom::model(|| {
        let owners = Arc::new(Owners::new(3));
        // loom tells when two threads are in it at once.
        let between = Arc::new(UnsafeCell::new(0));
        let insert = |me: usize, vertices: [u32; 2]| {
            let (owners, between) = (Arc::clone(&owners), Arc::clone(&between));
            move || {
                let mut holder = owners.holder(me);
                let mut done = 0;
                for _ in 0..2 {
                    if holder.hold(vertices) {
                        // SAFETY: vertex 1 is held.
                        between.with_mut(|count| unsafe { *count += 1 });
                        done += 1;
                        holder.done();
                    } else {
                        holder.back_off();
                    }
                }
                holder.release();
                done
            }
        };
        let other = thread::spawn(insert(1, [1, 2]));
        let done = insert(0, [0, 1])() + other.join().unwrap();
        // SAFETY: the other thread has ended.
        assert_eq!(between.with(|count| unsafe { *count }), done);
    });
}

/// The mesh of the next two models: a simplex of the vertices 1, 2, 3, and the one that takes its slot, with site 0 for 1. Its
/// neighbor tells which of the two it is.
const OLD: Simplex<3> = Simplex { vertices: [1, 2, 3], neighbors: [10, 11, 12] };
const NEW: Simplex<3> = Simplex { vertices: [0, 2, 3], neighbors: [20, 21, 22] };

/// As [`NEW`] is inserted: the cavity is held first, then the site, of which nobody knows yet.
fn replace(owners: &Owners, record: &Record<3>) {
    let mut holder = owners.holder(0);
    if holder.hold(OLD.vertices) {
        holder.hold_new(0);
        record.set(NEW);
    }
    holder.release();
}

/// A thread whose walk has come to a slot: it reads, holds what it has read, and reads again. If that is the same, all of the
/// record is of one simplex.
#[test]
fn what_a_walk_came_to_is_whole_once_it_is_held() {
    loom::model(|| {
        let owners = Arc::new(Owners::new(4));
        let record = Arc::new(Record::default());
        record.set(OLD);
        let writer = {
            let (owners, record) = (Arc::clone(&owners), Arc::clone(&record));
            thread::spawn(move || replace(&owners, &record))
        };
        let mut holder = owners.holder(1);
        let vertices = record.vertices();
        if holder.hold(vertices) && record.vertices() == vertices {
            let expected = [OLD, NEW].into_iter().find(|simplex| simplex.vertices == vertices);
            let expected = expected.expect("half of each is no simplex");
            assert_eq!(record.neighbors(), expected.neighbors);
        }
        holder.release();
        writer.join().unwrap();
    });
}

/// The same for a slot of its own that an insertion takes, gives back, because it finds another vertex held, and takes again when it
/// is tried again. By then others may know of its site. What was taken back is never found whole.
#[test]
fn what_was_taken_back_is_no_simplex() {
    const FIRST_ATTEMPT: Simplex<3> = Simplex { vertices: [5, 1, 2], neighbors: [10, 11, 12] };
    const SECOND_ATTEMPT: Simplex<3> = Simplex { vertices: [5, 3, 4], neighbors: [20, 21, 22] };
    is_found_whole(
        Simplex { vertices: [0; 3], neighbors: [0; 3] },
        SECOND_ATTEMPT,
        |holder, record| {
            if holder.hold([1, 2]) {
                holder.hold_new(5);
                record.set(FIRST_ATTEMPT);
                record.kill();
                holder.release();
                if holder.hold([3, 4, 5]) {
                    record.set(SECOND_ATTEMPT);
                }
            }
        },
    );
}

/// The same for a slot of the cavity, into which its simplex is written back.
#[test]
fn what_was_there_before_is_whole_again() {
    const STAR: Simplex<3> = Simplex { vertices: [5, 2, 3], neighbors: [20, 21, 22] };
    is_found_whole(OLD, STAR, |holder, record| {
        if holder.hold(OLD.vertices) {
            holder.hold_new(5);
            record.set(STAR);
            record.set(OLD);
            holder.release();
            if holder.hold(OLD.vertices) && holder.hold([5]) {
                record.set(STAR);
            }
        }
    });
}

/// Lets one thread write a record that holds `before` and in the end `after`, and another come to it by a walk.
fn is_found_whole(
    before: Simplex<3>,
    after: Simplex<3>,
    write: impl Fn(&mut Holder<'_>, &Record<3>) + Copy + Send + Sync + 'static,
) {
    loom::model(move || {
        let owners = Arc::new(Owners::new(6));
        let record = Arc::new(Record::<3>::default());
        record.set(before);
        let writer = {
            let (owners, record) = (Arc::clone(&owners), Arc::clone(&record));
            thread::spawn(move || {
                let mut holder = owners.holder(0);
                write(&mut holder, &record);
                holder.release();
            })
        };
        let mut holder = owners.holder(1);
        let vertices = record.vertices();
        let [a, b, c] = vertices;
        let is_triangle = a != u32::MAX - 1 && a != b && b != c && c != a;
        if is_triangle && holder.hold(vertices) && record.vertices() == vertices {
            let expected = [before, after].into_iter().find(|simplex| simplex.vertices == vertices);
            let expected = expected.expect("half of each is no simplex");
            assert_eq!(record.neighbors(), expected.neighbors);
        }
        holder.release();
        writer.join().unwrap();
    });
}

/// The same for a slot that became free in one insertion and is taken in a later one, by a simplex that has no vertex of the former.
/// While it is written, its new site is held, and nothing of what was there before.
#[test]
fn a_slot_that_is_used_again_is_whole_once_it_is_held() {
    const SUCCESSOR: Simplex<3> = Simplex { vertices: [0, 4, 5], neighbors: [20, 21, 22] };
    loom::model(|| {
        let owners = Arc::new(Owners::new(6));
        let record = Arc::new(Record::default());
        record.set(OLD);
        let writer = {
            let (owners, record) = (Arc::clone(&owners), Arc::clone(&record));
            thread::spawn(move || {
                let mut holder = owners.holder(0);
                if holder.hold(OLD.vertices) {
                    record.kill();
                    holder.release();
                    if holder.hold([4, 5]) {
                        holder.hold_new(0);
                        record.set(SUCCESSOR);
                    }
                }
                holder.release();
            })
        };
        let mut holder = owners.holder(1);
        let vertices = record.vertices();
        let is_dead = vertices[0] == u32::MAX - 1;
        if !is_dead && holder.hold(vertices) && record.vertices() == vertices {
            let expected =
                [OLD, SUCCESSOR].into_iter().find(|simplex| simplex.vertices == vertices);
            let expected = expected.expect("half of each is no simplex");
            assert_eq!(record.neighbors(), expected.neighbors);
        }
        holder.release();
        writer.join().unwrap();
    });
}

/// The same for a slot that was never in use, which a walk may come to before it sees what was written.
#[test]
fn a_slot_that_was_never_used_is_no_simplex() {
    loom::model(|| {
        let owners = Arc::new(Owners::new(4));
        let record = Arc::new(Record::<3>::default());
        let writer = {
            let (owners, record) = (Arc::clone(&owners), Arc::clone(&record));
            thread::spawn(move || replace(&owners, &record))
        };
        let mut holder = owners.holder(1);
        let vertices = record.vertices();
        let [a, b, c] = vertices;
        let is_triangle = a != b && b != c && c != a;
        if is_triangle && holder.hold(vertices) && record.vertices() == vertices {
            assert_eq!(vertices, NEW.vertices);
            assert_eq!(record.neighbors(), NEW.neighbors);
        }
        holder.release();
        writer.join().unwrap();
    });
}

/// Two threads that make simplices have slots of their own, as many as there is room for, and what is left over is dead.
#[test]
fn each_slot_is_taken_by_one_thread() {
    const SLOTS: u32 = 5;
    loom::model(|| {
        let next = Arc::new(AtomicU32::new(0));
        let records: Arc<Vec<Record<3>>> =
            Arc::new((0..SLOTS).map(|_| Record::default()).collect());
        let make = |me: u32| {
            let (next, records) = (Arc::clone(&next), Arc::clone(&records));
            move || {
                let mut own = OwnSlots::default();
                let mut made = Vec::new();
                for _ in 0..2 {
                    let room = Room { next: &next, end: SLOTS };
                    if own.reserve(2, room, &records) {
                        for _ in 0..2 {
                            let slot = own.pop();
                            let vertices = [me, slot + 10, slot + 20];
                            records[slot as usize].set(Simplex { vertices, neighbors: [0; 3] });
                            made.push(slot);
                        }
                    }
                }
                (own, made)
            }
        };
        let other = thread::spawn(make(2));
        let (mut own, mut made) = make(1)();
        let (mut others, more) = other.join().unwrap();
        made.extend(more);
        own.give_back(&next, &records);
        others.give_back(&next, &records);
        let used = next.load(Relaxed);
        made.sort_unstable();
        assert!(made.is_sorted_by(|a, b| a < b), "each once: {made:?}");
        for slot in 0..used {
            let is_live = records[slot as usize].vertex(0) != u32::MAX - 1;
            assert_eq!(is_live, made.contains(&slot), "{slot} of {used}, {made:?}");
        }
        assert!(made.iter().all(|&slot| slot < used));
    });
}

/// Two threads go along their runs, and one helps the other: each site once.
#[test]
fn each_site_is_inserted_once() {
    loom::model(|| {
        let runs = Arc::new(Runs::new(7, 2, false));
        let take = |me: usize| {
            let runs = Arc::clone(&runs);
            move || {
                let mut taken = Vec::new();
                while let Some(block) = runs.take(me) {
                    taken.extend(block.places());
                }
                taken
            }
        };
        let other = thread::spawn(take(1));
        let mut taken = take(0)();
        taken.extend(other.join().unwrap());
        taken.sort_unstable();
        assert_eq!(taken, [0, 1, 2, 3, 4, 5, 6]);
    });
}
