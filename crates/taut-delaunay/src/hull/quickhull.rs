//! Quickhull in space, with exact signs.
//!
//! *Idea.* Each facet keeps points beyond it. Take a facet and the farthest of its points; the facets that it is beyond are a
//! disc, and go; the edges around the disc are joined with the point. Points of facets that went are handed to the new ones,
//! and dropped if they are beyond none.
//! *Guarantee.* A point is beyond a facet, on its plane or behind it, exactly: by the height over the plane where its error bound
//! tells, else by exact arithmetic. A point on the plane counts as behind, so facets of one plane go together, and what is
//! left at the end is the boundary of the hull, faces perhaps cut into triangles with needless vertices.
//! *Trap.* Which point is farthest is rounded. It does not matter: any point beyond the facet will do.
//! *Why no point is lost.* A point beyond facets on both sides of an edge of the horizon is beyond the new facet at this edge,
//! whose plane lies between theirs. So if it is beyond a facet that stays and one that went, it is beyond a new one.
//! *Reference.* Barber, Dobkin, Huhdanpaa, *The quickhull algorithm for convex hulls*, ACM Trans. Math. Softw. 22, 1996.

use taut_points::Monitor;
use taut_predicates::Sign;
use taut_predicates::space::{UNDERFLOW_ERROR, orient};

use crate::Error;
use crate::vector::{cross, difference, dot};

/// Relative to the permanent, more than the height over a plane can be off by: the eight roundings of the orientation's filter, and
/// some of the bound itself.
const HEIGHT_ERROR: f64 = 6.0 * f64::EPSILON;

/// Facets that are treated between two questions of the monitor.
const STEPS_PER_CHECK: usize = 1 << 10;

/// A triangle of the hull under construction.
pub(super) struct Facet {
    /// Sites, counter-clockwise from outside.
    pub(super) vertices: [u32; 3],
    /// For each vertex the facet across the edge opposite it.
    pub(super) neighbors: [u32; 3],
    pub(super) plane: FacetPlane,
    /// Sites beyond.
    outside: Vec<u32>,
    /// The greatest height of these, and where it is in `outside`.
    farthest: (f64, u32),
    is_alive: bool,
    /// The last step that looked at it, and what it saw.
    seen: (u32, bool),
}

/// The plane of a facet, rounded.
#[derive(Clone, Copy)]
pub(super) struct FacetPlane {
    at: [f64; 3],
    /// Outward, of twice the area of the facet.
    pub(super) normal: [f64; 3],
    /// No computed height of a site is off by more.
    pub(super) margin: f64,
}

impl FacetPlane {
    /// How far a point is above the plane, times twice the area of the facet; rounded.
    #[inline(always)]
    pub(super) fn height(&self, p: [f64; 3]) -> f64 {
        dot(self.normal, difference(p, self.at))
    }

    /// Tests whether a point is above the plane, if rounding does not hide it.
    #[inline(always)]
    pub(super) fn has_below(&self, p: [f64; 3]) -> Option<bool> {
        let height = self.height(p);
        (height.abs() > self.margin).then_some(height > 0.0)
    }
}

/// A hull under construction.
pub(super) struct QuickHull {
    pub(super) sites: Vec<[f64; 3]>,
    /// The row of each site.
    pub(super) rows: Vec<u32>,
    facets: Vec<Facet>,
    /// Facets that may have points beyond them.
    open: Vec<u32>,
    /// Slots of facets that went.
    free: Vec<u32>,
    /// The extent of all points along each axis.
    extent: [f64; 3],
    /// False if no computed height can be relied on.
    filtered: bool,
    step: u32,
    /// For each site on the horizon the new facets that start and end there.
    joints: Vec<[u32; 2]>,
}

impl QuickHull {
    /// Begins with the tetrahedron of four affinely independent sites. Sites are distinct; among them, or among those that are
    /// added, none has a coordinate outside the box of these.
    pub(super) fn new(
        sites: Vec<[f64; 3]>,
        rows: Vec<u32>,
        mut start: [u32; 4],
        filtered: bool,
    ) -> Self {
        let extent = std::array::from_fn(|k| {
            let values = || sites.iter().map(|p| p[k]);
            values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
        });
        let mut quick = Self {
            sites,
            rows,
            facets: Vec::new(),
            open: Vec::new(),
            free: Vec::new(),
            extent,
            filtered,
            step: 0,
            joints: Vec::new(),
        };
        let [a, b, c, d] = start.map(|i| quick.sites[i as usize]);
        if orient(a, b, c, d) == Sign::Negative {
            start.swap(2, 3);
        }
        let [a, b, c, d] = start;
        for vertices in [[b, c, d], [a, d, c], [a, b, d], [a, c, b]] {
            // The facet across the edge opposite a vertex is the one that lacks this vertex.
            let across = |v| start.iter().position(|&s| s == v).unwrap_or(0) as u32;
            let facet = quick.facet(vertices, vertices.map(across));
            quick.facets.push(facet);
        }
        for site in 0..quick.sites.len() as u32 {
            if !start.contains(&site)
                && let Some(facet) = quick.beyond(quick.sites[site as usize])
            {
                quick.hand(site, facet);
            }
        }
        quick
    }

    fn facet(&self, vertices: [u32; 3], neighbors: [u32; 3]) -> Facet {
        let [a, b, c] = vertices.map(|v| self.sites[v as usize]);
        let (u, v) = (difference(b, a), difference(c, a));
        let permanent: f64 = (0..3)
            .map(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                self.extent[i] * ((u[j] * v[k]).abs() + (u[k] * v[j]).abs())
            })
            .sum();
        let margin =
            if self.filtered { HEIGHT_ERROR * permanent + UNDERFLOW_ERROR } else { f64::INFINITY };
        Facet {
            vertices,
            neighbors,
            plane: FacetPlane { at: a, normal: cross(u, v), margin },
            outside: Vec::new(),
            farthest: (f64::NEG_INFINITY, 0),
            is_alive: true,
            seen: (0, false),
        }
    }

    /// The facets that are left.
    pub(super) fn facets(&self) -> impl Iterator<Item = (u32, &Facet)> {
        (0u32..).zip(&self.facets).filter(|(_, facet)| facet.is_alive)
    }

    #[inline(always)]
    fn is_beyond(&self, facet: &Facet, p: [f64; 3]) -> bool {
        facet.plane.has_below(p).unwrap_or_else(|| self.is_beyond_exactly(facet, p))
    }

    #[cold]
    fn is_beyond_exactly(&self, facet: &Facet, p: [f64; 3]) -> bool {
        let [a, b, c] = facet.vertices.map(|v| self.sites[v as usize]);
        orient(a, b, c, p) == Sign::Positive
    }

    /// The first facet that a point is beyond.
    pub(super) fn beyond(&self, p: [f64; 3]) -> Option<u32> {
        self.facets().find(|(_, facet)| self.is_beyond(facet, p)).map(|(number, _)| number)
    }

    /// The planes of all facets side by side, for [`beyond_some`](Self::beyond_some).
    pub(super) fn planes(&self) -> Vec<(u32, FacetPlane)> {
        self.facets().map(|(number, facet)| (number, facet.plane)).collect()
    }

    /// The same as [`beyond`](Self::beyond), from the planes of all facets.
    #[inline(always)]
    pub(super) fn beyond_some(&self, planes: &[(u32, FacetPlane)], p: [f64; 3]) -> Option<u32> {
        let is_beyond = |&&(number, plane): &&(u32, FacetPlane)| {
            let exactly = || self.is_beyond_exactly(&self.facets[number as usize], p);
            plane.has_below(p).unwrap_or_else(exactly)
        };
        planes.iter().find(is_beyond).map(|&(number, _)| number)
    }

    /// Adds points, each with a facet that it is beyond.
    pub(super) fn add(&mut self, points: impl Iterator<Item = ([f64; 3], u32, u32)>) {
        for (p, row, facet) in points {
            let site = self.sites.len() as u32;
            self.sites.push(p);
            self.rows.push(row);
            self.hand(site, facet);
        }
    }

    /// Hands a site to a facet that it is beyond.
    #[inline]
    fn hand(&mut self, site: u32, number: u32) {
        let facet = &mut self.facets[number as usize];
        let height = facet.plane.height(self.sites[site as usize]);
        if facet.outside.is_empty() {
            self.open.push(number);
        }
        // Of equal points, which have equal heights, the one of the lowest row is to become the vertex.
        let (most, place) = facet.farthest;
        let is_lower = || facet.outside.get(place as usize).is_some_and(|&other| site < other);
        if height > most || height == most && is_lower() {
            facet.farthest = (height, facet.outside.len() as u32);
        }
        facet.outside.push(site);
    }

    /// Goes on until no site is beyond a facet.
    pub(super) fn run(&mut self, monitor: &Monitor<'_>) -> Result<(), Error> {
        self.joints.resize(self.sites.len(), [0; 2]);
        let mut steps = 0;
        while let Some(number) = self.open.pop() {
            // A slot may have been taken by a facet without points since.
            if !self.facets[number as usize].outside.is_empty() {
                self.advance(number);
            }
            steps += 1;
            if steps % STEPS_PER_CHECK == 0 {
                monitor.check()?;
            }
        }
        Ok(())
    }

    /// Joins the hull with the farthest site beyond a facet.
    fn advance(&mut self, number: u32) {
        let facet = &mut self.facets[number as usize];
        let apex = facet.outside.swap_remove(facet.farthest.1 as usize);
        let p = self.sites[apex as usize];
        self.step += 1;
        let step = self.step;
        self.facets[number as usize].seen = (step, true);
        // The facets that the site is beyond, and the edges around them with the facets behind.
        let (mut disc, mut horizon) = (vec![number], Vec::new());
        let mut next = 0;
        while next < disc.len() {
            let Facet { vertices, neighbors, .. } = self.facets[disc[next] as usize];
            for i in 0..3 {
                let other = neighbors[i];
                let facet = &self.facets[other as usize];
                let is_beyond =
                    if facet.seen.0 == step { facet.seen.1 } else { self.is_beyond(facet, p) };
                let is_new = facet.seen.0 != step;
                self.facets[other as usize].seen = (step, is_beyond);
                if !is_beyond {
                    horizon.push((vertices[(i + 1) % 3], vertices[(i + 2) % 3], other));
                } else if is_new {
                    disc.push(other);
                }
            }
            next += 1;
        }
        let mut orphans = Vec::new();
        for &gone in &disc {
            let facet = &mut self.facets[gone as usize];
            facet.is_alive = false;
            orphans.append(&mut facet.outside);
        }
        self.free.extend(&disc);
        let fresh: Vec<u32> = horizon
            .iter()
            .map(|&(from, to, behind)| {
                let facet = self.facet([from, to, apex], [0, 0, behind]);
                match self.free.pop() {
                    Some(slot) => {
                        self.facets[slot as usize] = facet;
                        slot
                    }
                    None => {
                        self.facets.push(facet);
                        self.facets.len() as u32 - 1
                    }
                }
            })
            .collect();
        for (&(from, to, behind), &number) in horizon.iter().zip(&fresh) {
            self.joints[from as usize][0] = number;
            self.joints[to as usize][1] = number;
            let facet = &mut self.facets[behind as usize];
            // Behind, the edge runs the other way.
            let place = (0..3)
                .find(|i| facet.vertices[(i + 1) % 3] == to && facet.vertices[(i + 2) % 3] == from);
            facet.neighbors[place.unwrap_or(0)] = number;
        }
        for (&(from, to, _), &number) in horizon.iter().zip(&fresh) {
            let (after, before) = (self.joints[to as usize][0], self.joints[from as usize][1]);
            let neighbors = &mut self.facets[number as usize].neighbors;
            (neighbors[0], neighbors[1]) = (after, before);
        }
        for site in orphans {
            let p = self.sites[site as usize];
            let facet = fresh.iter().find(|&&n| self.is_beyond(&self.facets[n as usize], p));
            if let Some(&number) = facet {
                self.hand(site, number);
            }
        }
    }
}
