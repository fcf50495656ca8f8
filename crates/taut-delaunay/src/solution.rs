//! From a triangulation to the answer with its certificate, in canonical order and in rows of the input.

use std::collections::BTreeMap;

use taut_certify::{
    Fingerprint, NO_NEIGHBOR, SiteHash, Solution, Stop, Trace, Triangulation as Answer,
    TriangulationCertificate, TriangulationCounts,
};
use taut_points::parallel::{IntoParallel, ParallelSlice};
use taut_points::{InputError, Monitor, PointSource, Points, Rows, Scalar, Scratch, hash_points};

use crate::canonical::{CanonicalOrder, arrangement};
use crate::simplex::{Simplex, Slots, code, decode};
use crate::triangulation::hull_facet;
use crate::{Complex, DelaunayOptions, Error, Plane, Space, Triangulation};

/// Simplices one task writes.
const TASK: usize = 1 << 12;

/// The Delaunay triangulation of points of the plane or of space, with the certificate that `taut verify` re-checks.
///
/// The answer is the same for any number of threads and any order of insertion, byte for byte. The points of a source are
/// held in memory.
///
/// # Errors
/// [`Error::Input`] for other dimensions than 2 and 3, when the points cannot be read or the monitor stops the work; else
/// what [`Plane::build`] and [`Space::build`] refuse.
pub fn delaunay(
    source: &dyn PointSource,
    options: &DelaunayOptions<'_>,
) -> Result<Solution<Answer>, Error> {
    fn solve<T: Scalar>(
        points: &Points<'_, T>,
        options: &DelaunayOptions<'_>,
    ) -> Result<Solution<Answer>, Error> {
        match points.dim() {
            2 => Plane::build(points, options)?.solution(points, &options.monitor),
            3 => Space::build(points, options)?.solution(points, &options.monitor),
            dim => Err(Error::Input(InputError::Dimension {
                dim,
                expected: "2, the plane, or 3, space",
            })),
        }
    }
    let mut scratch = Scratch::new();
    match source.read(0..source.len(), &mut scratch)? {
        Rows::F32(points) => solve(&points, options),
        Rows::F64(points) => solve(&points, options),
    }
}

/// The rows of an answer, before they are tied to points.
#[derive(Default)]
struct Tables {
    simplices: Vec<u32>,
    neighbors: Vec<u32>,
    hull: Vec<u32>,
    fingerprint: Fingerprint,
}

impl<const D: usize, const V: usize> Triangulation<D, V> {
    /// The answer and its certificate, in rows of the input and in canonical order.
    ///
    /// `points` are those it was built from. O(simplices), and as much memory again.
    ///
    /// # Errors
    /// [`Error::OtherPoints`] if `points` are so many or so few that they cannot be those, [`Error::Input`], or [`Error::Input`] when hashing the points is stopped.
    pub fn solution<T: Scalar>(
        &self,
        points: &Points<'_, T>,
        monitor: &Monitor<'_>,
    ) -> Result<Solution<Answer>, Error> {
        let rows = self.sites.len() + self.sites.duplicates.len();
        if points.len() != rows || points.dim() != D {
            return Err(Error::OtherPoints { built: rows as u64, given: points.len() as u64 });
        }
        let hashes: Vec<SiteHash> = (0..self.sites.len() as u32)
            .into_par_iter()
            .with_min_len(TASK)
            .map(|s| SiteHash::of(&self.site(s)))
            .collect();
        let (hull_dimension, tables) = match &self.complex {
            Complex::Nothing => (None, Tables::default()),
            Complex::Point => (Some(0), self.point(&hashes)),
            Complex::Line(chain) => (Some(1), self.line(chain, &hashes)),
            Complex::Flat(triangles) => (Some(2), self.flat(triangles, &hashes)),
            Complex::Full => (Some(D as u8), self.tables::<D, V>(&self.slots, &hashes)),
        };
        let points_hash = hash_points(points, monitor)?;
        let sites = self.sites.len() as u64;
        let answer = Answer {
            dimension: D as u8,
            hull_dimension,
            simplices: tables.simplices,
            hull: tables.hull,
            duplicates: self.sites.duplicates.clone(),
        };
        let facets = hull_dimension.map_or(0, |d| answer.hull.len() / usize::from(d).max(1));
        let counts =
            TriangulationCounts { sites, simplices: answer.len() as u64, hull: facets as u64 };
        let trace = Trace {
            method: self.method.into(),
            stop: Stop::Converged,
            passes: 1,
            counters: BTreeMap::from([
                ("sites".into(), sites),
                ("duplicates".into(), answer.duplicates.len() as u64),
            ]),
            ..Trace::default()
        };
        let certificate = TriangulationCertificate {
            neighbors: tables.neighbors,
            fingerprint: tables.fingerprint,
            points_hash,
            counts,
        };
        Ok(Solution { answer, certificate, trace })
    }

    fn point(&self, hashes: &[SiteHash]) -> Tables {
        let mut fingerprint = Fingerprint::default();
        fingerprint.add([hashes[0]]);
        Tables {
            simplices: vec![self.row(0)],
            neighbors: vec![NO_NEIGHBOR],
            hull: vec![],
            fingerprint,
        }
    }

    fn line(&self, chain: &[u32], hashes: &[SiteHash]) -> Tables {
        let edges = chain.len() as u32 - 1;
        let mut tables = Tables {
            hull: vec![self.row(chain[0]), self.row(chain[chain.len() - 1])],
            ..Tables::default()
        };
        for (edge, ends) in (0..edges).zip(chain.windows(2)) {
            tables.simplices.extend(ends.iter().map(|&site| self.row(site)));
            // Opposite the first end lies the edge that follows, opposite the second the one before.
            let next = if edge + 1 < edges { edge + 1 } else { NO_NEIGHBOR };
            tables.neighbors.extend([next, edge.wrapping_sub(1)]);
            tables.fingerprint.add([0, 1].map(|i| hashes[ends[i] as usize]));
        }
        tables
    }

    /// Triangles on a plane in space, turned as the answer wants them.
    fn flat(&self, triangles: &Slots<3>, hashes: &[SiteHash]) -> Tables {
        let positive =
            triangles.iter().find(|s| !s.is_ghost()).is_none_or(|s| self.turns_left(s.vertices));
        if positive {
            return self.tables::<2, 3>(triangles, hashes);
        }
        let turned: Vec<Simplex<3>> = triangles
            .iter()
            .map(|s| Simplex {
                vertices: [0, 2, 1].map(|i| s.vertices[i]),
                neighbors: [0, 2, 1].map(|i| {
                    let (other, facet) = decode(s.neighbors[i]);
                    code(other, [0, 2, 1][facet])
                }),
            })
            .collect();
        self.tables::<2, 3>(&Slots::of(turned), hashes)
    }

    /// Tests whether a triangle in space is counter-clockwise in the first of the projections to xy, xz, yz where it is not
    /// flat.
    fn turns_left(&self, vertices: [u32; 3]) -> bool {
        let corners = vertices.map(|v| self.sites.coordinates[v as usize]);
        let sign = |[i, j]: [usize; 2]| {
            let [a, b, c] = corners.map(|p| [p[i], p[j]]);
            taut_predicates::plane::orient(a, b, c)
        };
        let first = [[0, 1], [0, 2], [1, 2]]
            .into_iter()
            .map(sign)
            .find(|&s| s != taut_predicates::Sign::Zero);
        first == Some(taut_predicates::Sign::Positive)
    }

    /// Simplices of dimension `K` = `W` − 1 in canonical order.
    fn tables<const K: usize, const W: usize>(
        &self,
        simplices: &Slots<W>,
        hashes: &[SiteHash],
    ) -> Tables {
        let order = CanonicalOrder::of(simplices, self.sites.len());
        let mut tables = Tables {
            simplices: vec![0; order.finite.len() * W],
            neighbors: vec![0; order.finite.len() * W],
            ..Tables::default()
        };
        let rows = tables
            .simplices
            .par_chunks_mut(W * TASK)
            .zip(tables.neighbors.par_chunks_mut(W * TASK));
        let fingerprints =
            rows.zip(order.finite.par_chunks(TASK)).map(|((vertices, neighbors), slots)| {
                let mut fingerprint = Fingerprint::default();
                for ((v, n), &slot) in
                    vertices.chunks_exact_mut(W).zip(neighbors.chunks_exact_mut(W)).zip(slots)
                {
                    let simplex = &simplices[slot as usize];
                    for (k, &i) in arrangement(&simplex.vertices).iter().enumerate() {
                        v[k] = self.row(simplex.vertices[usize::from(i)]);
                        n[k] = order.places[decode(simplex.neighbors[usize::from(i)]).0 as usize];
                    }
                    fingerprint.add(simplex.vertices.map(|s| hashes[s as usize]));
                }
                fingerprint
            });
        tables.fingerprint = fingerprints.collect::<Vec<_>>().into_iter().fold(
            Fingerprint::default(),
            |mut all, one| {
                all.merge(one);
                all
            },
        );
        let open = tables.neighbors.iter().enumerate().filter(|&(_, &n)| n == NO_NEIGHBOR);
        for (at, _) in open {
            let simplex = &simplices[order.finite[at / W] as usize];
            let behind = usize::from(arrangement(&simplex.vertices)[at % W]);
            let ghost = decode(simplex.neighbors[behind]).0;
            let mut facet = hull_facet::<K, W>(simplices[ghost as usize].vertices);
            let first = (0..K).min_by_key(|&i| facet[i]).unwrap_or(0);
            // Turning keeps the orientation of three, and an edge stays as it is.
            if K == 3 {
                facet.rotate_left(first);
            }
            tables.hull.extend(facet.map(|s| self.row(s)));
        }
        tables
    }
}
