//! Several threads insert into one mesh.
//!
//! *Problem.* Share the insertion of sites among threads, for any set: where spheres are large, pieces of the set cannot be
//! triangulated apart from each other.
//! *Idea.* The Delaunay triangulation is a function of the set of sites, so it does no harm in which order they come. All
//! threads insert into the mesh at once, each along its own run of the curve. A thread *holds* vertices, by an exchange on a
//! byte of each; it destroys a simplex only while it holds all finite vertices of it. An insertion that meets a vertex which
//! another thread holds takes back what it wrote, gives back what it has, and is tried again.
//! *Guarantee.* Two cavities that are held at once have no finite vertex in common, so they share no simplex, and a simplex outside
//! both cannot touch both with a facet: two facets of a simplex have a finite vertex in common. (The ghosts of the plane are the
//! exception: two threads may change one, each a number of its own and nothing else.) So who sees a simplex across a facet of its
//! cavity reads and changes it alone, and what it reads is as the last thread left it, since each gives its vertices back after its
//! last store and takes them before its first load. Each insertion leaves all facets locally Delaunay, so the mesh is Delaunay at
//! the end, whoever came first. No thread waits without bound for another, so there is no deadlock; sites that failed are inserted by
//! one thread at the end of a round.
//! *Guarantee.* The new site is held as well while its simplices are written, without an exchange where nobody can have read of it.
//! Word 0 of a record is the site whose insertion wrote it, and what a star wrote that is taken back is overwritten before its site
//! is given back: who holds what it read of a record, and reads the same again, has all of it.
//! *Trap.* Walks hold nothing. They may read half of an old and half of a new simplex, so they are followed a bounded number of
//! steps, and the simplex they end in is held, read once more and tested again.
//! *Trap.* Where one vertex is in most cavities (an apex over a line of sites) threads only get into each other's way: the rest
//! of a round is left to one thread when more than one attempt in twenty fails.
//! *Reference.* Foteinos and Chrisochoides, *High quality real-time image-to-mesh conversion*, 2014, for vertices that are held
//! in a Delaunay refinement; Batista et al., Comput. Geom. 43, 2010, for locks on simplices and vertices compared.
//!
//! `held` says who holds what, `slots` where new simplices go, `runs` who inserts which sites, `round` does it; `alone` is for one
//! thread.

mod alone;
pub(crate) mod atomics;
mod held;
mod record;
mod round;
mod runs;
mod slots;
#[cfg(test)]
mod tests;

pub(crate) use alone::{Alone, Plain, plain_marks, plain_records};
pub(crate) use held::{Hold, Holder, Owners};
pub(crate) use record::{Mark, Record, Slot};
pub(crate) use round::{Inserted, Progress, SharedMesh, insert_round, repair_beginnings};
pub(crate) use slots::{OwnSlots, Room};
