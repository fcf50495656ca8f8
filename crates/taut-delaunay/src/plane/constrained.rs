//! Segments that must be edges: the constrained Delaunay triangulation of the plane.
//!
//! *Problem.* Given sites and segments between them that do not cross, find the triangulation that has all segments as
//! edges and is Delaunay as far as they let it: no other edge can be flipped for the better.
//! *Idea.* One segment after another. The triangles it crosses are a corridor; take them out, and fill what lies left
//! and right of the segment again, each side from its base: the third vertex of a triangle is the one whose circle
//! through the base holds no other vertex of that side ([`corridor`]).
//! *Guarantee.* All signs are exact, ties are broken by the lexicographic perturbation, so the triangulation is a
//! function of the sites and of the set of segments. A segment through a site is split there and the split reported;
//! segments that overlap share their edges; segments that cross are an error that names both.
//! *Cost.* A segment that is an edge already costs the smaller degree of its ends. One that crosses k edges costs at
//! worst O(k²) conflict tests; O(k log k) where the corridor splits evenly, as it does among points in general.
//! *Trap.* A corridor may touch itself: an edge that hangs into it has both its sides inside. So vertices may come up
//! twice along a side, and such an edge has no outside to be linked to.
//! *Reference.* Chew, Constrained Delaunay triangulations, Algorithmica 4, 1989; Anglada, An improved incremental
//! algorithm for constructing restricted Delaunay triangulations, Computers & Graphics 21, 1997, the filling.

mod corridor;
mod marks;
#[cfg(test)]
mod tests;

use taut_points::OrderBy;
use taut_predicates::plane::{lexicographic, orient};

use crate::simplex::{GHOST, Simplex, code, decode};
use corridor::Corridor;
pub use marks::Constrained;

/// Two sites that must be joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// A site.
    pub from: u32,
    /// Another; if it is the same, the segment asks for nothing.
    pub to: u32,
    /// Part of a closed ring: what lies on its other side is inside if this side is outside, and the other way round.
    pub ring: bool,
}

/// A segment goes through a site: its edges meet there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Split {
    /// The segment, by its place in the input.
    pub segment: u32,
    /// The site between its ends.
    pub site: u32,
}

/// An edge of the triangulation that segments ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Piece {
    /// The ends, the smaller number first.
    pub sites: [u32; 2],
    /// The first of the segments that it is part of, by its place in the input.
    pub segment: u32,
    /// True if an odd number of segments of rings goes along it.
    pub odd: bool,
}

/// The results for the segments.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Pieces {
    /// In the order of their ends, each edge once.
    pub pieces: Vec<Piece>,
    /// In the order of segments and sites.
    pub splits: Vec<Split>,
}

/// Why segments cannot be edges of a triangulation.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ConstraintError {
    /// Two segments have a point in common that is no site.
    #[error(
        "segments {first} and {second} cross: give the point where they do as a site, and split both there"
    )]
    Crossing {
        /// The one that comes first in the input.
        first: u32,
        /// The other.
        second: u32,
    },
    /// A number that is not the number of a site.
    #[error("segment {segment} ends at site {site}, and there are {sites} sites")]
    NoSite {
        /// By its place in the input.
        segment: u32,
        /// The site that it gives as an end.
        site: u32,
        /// The number of them.
        sites: usize,
    },
    /// At this site a ring ends, so it has no inside.
    #[error(
        "the segments marked as rings do not close: an odd number of them meets at site {site}"
    )]
    Open {
        /// The first such site.
        site: u32,
    },
    /// The sites do not span the plane, so there are no triangles to constrain.
    #[error("all points lie on a line: there are no triangles that segments could be edges of")]
    Flat,
    /// Segments are numbered with 32 bits.
    #[error("{count} segments are more than can be numbered with 32 bits")]
    TooMany {
        /// The number of them.
        count: usize,
    },
}

/// No segment.
const NONE: u32 = u32::MAX;

/// Makes the segments edges of a Delaunay triangulation: closed by ghosts, without dead slots, of all these sites.
///
/// The same slots are used again, in an order that depends on that of the segments.
///
/// # Errors
/// If segments cross, name sites that are not there, or rings do not close. On [`ConstraintError::Crossing`] the
/// triangles hold the segments before the second one; on any other error nothing has changed.
pub(crate) fn constrain(
    sites: &[[f64; 2]],
    triangles: &mut [Simplex<3>],
    segments: &[Segment],
) -> Result<Pieces, ConstraintError> {
    check(sites.len(), segments)?;
    let mut mesh = Constraining::new(sites, triangles);
    let mut result = Pieces::default();
    for (number, &segment) in segments.iter().enumerate() {
        mesh.insert(number as u32, segment, &mut result)?;
    }
    result.pieces.order();
    result.pieces.dedup_by(|again, first| {
        let same = again.sites == first.sites;
        first.odd ^= same && again.odd;
        same
    });
    result.splits.order();
    Ok(result)
}

fn check(sites: usize, segments: &[Segment]) -> Result<(), ConstraintError> {
    if segments.len() >= NONE as usize {
        return Err(ConstraintError::TooMany { count: segments.len() });
    }
    let mut odd = vec![false; sites];
    for (number, segment) in segments.iter().enumerate() {
        for site in [segment.from, segment.to] {
            let Some(odd) = odd.get_mut(site as usize) else {
                return Err(ConstraintError::NoSite { segment: number as u32, site, sites });
            };
            *odd ^= segment.ring;
        }
    }
    match odd.into_iter().position(|odd| odd) {
        Some(site) => Err(ConstraintError::Open { site: site as u32 }),
        None => Ok(()),
    }
}

/// A triangulation whose edges may be owned by segments.
struct Constraining<'a> {
    sites: &'a [[f64; 2]],
    triangles: &'a mut [Simplex<3>],
    /// By triangle and facet, the first segment that owns the edge, or none; the same on both sides.
    owners: Vec<[u32; 3]>,
    /// A triangle at each site.
    around: Vec<u32>,
    corridor: Corridor,
}

/// The way in which a segment leaves its first site.
enum Exit {
    /// Along an edge to this site: the facet that is the edge.
    Edge(u32, u32),
    /// Through the facet opposite the site.
    Facet(u32),
}

impl<'a> Constraining<'a> {
    fn new(sites: &'a [[f64; 2]], triangles: &'a mut [Simplex<3>]) -> Constraining<'a> {
        let mut around = vec![0; sites.len()];
        for (number, t) in triangles.iter().enumerate() {
            for site in t.vertices.into_iter().filter(|&v| v != GHOST) {
                around[site as usize] = number as u32;
            }
        }
        let owners = vec![[NONE; 3]; triangles.len()];
        let corridor = Corridor::new(triangles.len());
        Constraining { sites, triangles, owners, around, corridor }
    }

    fn insert(
        &mut self,
        number: u32,
        segment: Segment,
        result: &mut Pieces,
    ) -> Result<(), ConstraintError> {
        let (mut from, mut to) = (segment.from, segment.to);
        while from != to {
            let (exit, turned) = self.leave(from, to);
            if turned {
                (from, to) = (to, from);
            }
            let next = match exit {
                Exit::Edge(next, facet) => {
                    self.own(facet, number);
                    next
                }
                Exit::Facet(facet) => self.cross(from, to, facet, number)?,
            };
            let sites = [from.min(next), from.max(next)];
            result.pieces.push(Piece { sites, segment: number, odd: segment.ring });
            if next != to {
                result.splits.push(Split { segment: number, site: next });
            }
            from = next;
        }
        Ok(())
    }

    /// The way from one site to the other, or the way back and `true`: looks around both at once, so that a site of
    /// many neighbors is not searched without result.
    fn leave(&self, from: u32, to: u32) -> (Exit, bool) {
        let mut here = self.around[from as usize];
        let mut there = self.around[to as usize];
        loop {
            if let Some(exit) = self.exit(from, to, here) {
                return (exit, false);
            }
            if let Some(exit) = self.exit(to, from, there) {
                return (exit, true);
            }
            here = self.turn(from, here);
            there = self.turn(to, there);
        }
    }

    /// The next triangle counter-clockwise around a site.
    fn turn(&self, site: u32, triangle: u32) -> u32 {
        let t = &self.triangles[triangle as usize];
        decode(t.neighbors[(place(t, site) + 1) % 3]).0
    }

    /// Tests whether the way from one site to another leaves by this triangle.
    fn exit(&self, from: u32, to: u32, triangle: u32) -> Option<Exit> {
        let t = &self.triangles[triangle as usize];
        let i = place(t, from);
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let (a, b) = (t.vertices[j], t.vertices[k]);
        if a == GHOST || b == GHOST {
            return None;
        }
        let [p, q, u, v] = [from, to, a, b].map(|site| self.sites[site as usize]);
        let (right, left) = (orient(p, q, u), orient(p, q, v));
        let ahead = |x| lexicographic(p, x) == lexicographic(p, q);
        if right.is_zero() && ahead(u) {
            Some(Exit::Edge(a, code(triangle, k as u32)))
        } else if left.is_zero() && ahead(v) {
            Some(Exit::Edge(b, code(triangle, j as u32)))
        } else if right.is_negative() && left.is_positive() {
            Some(Exit::Facet(code(triangle, i as u32)))
        } else {
            None
        }
    }

    /// Marks both sides of an edge; the first segment stays its owner.
    fn own(&mut self, facet: u32, number: u32) {
        let (t, i) = decode(facet);
        let (u, j) = decode(self.triangles[t as usize].neighbors[i]);
        for owner in [(t, i), (u, j)] {
            let owner = &mut self.owners[owner.0 as usize][owner.1];
            if *owner == NONE {
                *owner = number;
            }
        }
    }

    /// Makes the segment an edge as far as the first site on it, and returns that site. `facet` is the first to be
    /// crossed.
    fn cross(
        &mut self,
        from: u32,
        to: u32,
        facet: u32,
        number: u32,
    ) -> Result<u32, ConstraintError> {
        let point = |site: u32| self.sites[site as usize];
        self.corridor.begin(from, self.triangles, &self.owners, facet);
        let mut facet = facet;
        let end = loop {
            let (triangle, i) = decode(facet);
            let owner = self.owners[triangle as usize][i];
            if owner != NONE {
                self.corridor.abandon();
                return Err(ConstraintError::Crossing { first: owner, second: number });
            }
            let behind = self.triangles[triangle as usize].neighbors[i];
            let (next, j) = decode(behind);
            let apex = self.triangles[next as usize].vertices[j];
            let side = orient(point(from), point(to), point(apex));
            if side.is_zero() {
                self.corridor.end(self.triangles, &self.owners, behind);
                break apex;
            }
            facet = self.corridor.advance(self.triangles, &self.owners, behind, side.is_positive());
        };
        self.corridor.fill(self.sites, self.triangles, &mut self.owners, &mut self.around, number);
        Ok(end)
    }
}

fn place(t: &Simplex<3>, vertex: u32) -> usize {
    let [a, b, _] = t.vertices;
    if a == vertex {
        0
    } else if b == vertex {
        1
    } else {
        2
    }
}
