//! The course of the check: tiles are [read](super::reading) beside, and judged chunk by chunk by all threads.

use std::marker::PhantomData;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use taut_points::{Monitor, PointSource, Points, Rows};

use super::super::super::{Fingerprint, MeshViolation, NO_NEIGHBOR, SiteHash};
use super::super::facets::{Complex, Facets};
use super::super::geometry::{Geometry, Tetrahedra, Triangles};
use super::super::input::Input;
use super::super::signs::{Conflict, lexicographic};
use super::super::sites::Sites;
use super::between::{Across, Between, Side};
use super::hull::Hull;
use super::manifest::Manifest;
use super::overview::Overview;
use super::reading::{Part, Readers};
use super::rows::Coverage;
use super::tile::{Counts, OTHER_TILE, TileFile, TileSites, file_name};
use super::{Shares, TilesError, TilesVerdict, TilesViolation, TriangulationCounts, count};

/// All that is known before the first tile.
pub(super) struct Job<'a, const D: usize> {
    pub(super) folder: &'a Path,
    pub(super) manifest: &'a Manifest,
    pub(super) source: &'a dyn PointSource,
    pub(super) overview: Overview<D>,
    /// The order in which determinants take the coordinates.
    pub(super) axes: [usize; D],
    /// Vertices of a simplex.
    pub(super) vertices: u32,
    pub(super) temporary: PathBuf,
    pub(super) shares: Shares,
    pub(super) monitor: Monitor<'a>,
}

/// What one chunk adds to the triangulation.
#[derive(Default)]
pub(super) struct Judged {
    fingerprint: Fingerprint,
    ties: u64,
}

/// A kind of simplices: `V` vertices, facets of `F`.
pub(super) trait Kind<const D: usize, const V: usize, const F: usize> {
    /// The vertices of each facet, in positive order seen from outside.
    const FACETS: [[usize; F]; V];

    /// Judges a chunk; `neighbors` has the simplices of the chunk that are neighbors, numbered from its first.
    fn judge(
        &self,
        job: &Job<'_, D>,
        sites: &TileSites<D>,
        simplices: &[[u32; V]],
        neighbors: &[[u32; V]],
    ) -> Result<Judged, MeshViolation>;

    /// Tells where a point is with respect to the sphere of a simplex.
    fn conflict(&self, job: &Job<'_, D>, simplex: &[[f64; D]; V], point: &[f64; D]) -> Conflict;
}

/// Simplices with a sphere.
pub(super) struct Full<G>(PhantomData<G>);

impl<G> Full<G> {
    pub(super) fn new() -> Self {
        Full(PhantomData)
    }

    fn judge<const D: usize, const V: usize, const F: usize>(
        job: &Job<'_, D>,
        sites: &TileSites<D>,
        simplices: &[[u32; V]],
        neighbors: &[[u32; V]],
    ) -> Result<Judged, MeshViolation>
    where
        G: Geometry<D, V>,
        [u32; V]: Facets<F>,
    {
        let Overview { scale, signs, hash, .. } = job.overview;
        let Ok(points) = Points::new(sites.coordinates.as_flattened(), D) else {
            return Ok(Judged::default());
        };
        let input = Input::<D>::of_rows(Rows::F64(points), hash, scale, signs);
        let mut sites = Sites::of(&input);
        if !job.axes.is_sorted() {
            sites = sites.with_axes(job.axes);
        }
        let complex = Complex { sites: &sites, signs, simplices, neighbors };
        let paired = complex.check::<G, F>()?;
        Ok(Judged { fingerprint: paired.fingerprint, ties: paired.ties })
    }
}

impl<const D: usize> Kind<D, 3, 2> for Full<Triangles>
where
    Triangles: Geometry<D, 3>,
{
    const FACETS: [[usize; 2]; 3] = [[1, 2], [2, 0], [0, 1]];

    fn judge(
        &self,
        job: &Job<'_, D>,
        sites: &TileSites<D>,
        simplices: &[[u32; 3]],
        neighbors: &[[u32; 3]],
    ) -> Result<Judged, MeshViolation> {
        Self::judge::<D, 3, 2>(job, sites, simplices, neighbors)
    }

    fn conflict(&self, job: &Job<'_, D>, simplex: &[[f64; D]; 3], point: &[f64; D]) -> Conflict {
        job.overview.signs.conflict::<Triangles, D, 3>(simplex, point)
    }
}

impl Kind<3, 4, 3> for Full<Tetrahedra> {
    const FACETS: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

    fn judge(
        &self,
        job: &Job<'_, 3>,
        sites: &TileSites<3>,
        simplices: &[[u32; 4]],
        neighbors: &[[u32; 4]],
    ) -> Result<Judged, MeshViolation> {
        Self::judge::<3, 4, 3>(job, sites, simplices, neighbors)
    }

    fn conflict(&self, job: &Job<'_, 3>, simplex: &[[f64; 3]; 4], point: &[f64; 3]) -> Conflict {
        job.overview.signs.conflict::<Tetrahedra, 3, 4>(simplex, point)
    }
}

/// The edges of a chain in ascending order, or a single point. All facets go to [`Between`].
pub(super) struct Chain;

impl Chain {
    fn judge<const D: usize, const V: usize>(
        sites: &TileSites<D>,
        simplices: &[[u32; V]],
    ) -> Result<Judged, MeshViolation> {
        let mut judged = Judged::default();
        for (number, simplex) in simplices.iter().enumerate() {
            let points = simplex.map(|v| sites.coordinates[v as usize]);
            if !points.is_sorted_by(|p, q| lexicographic(p, q).is_lt()) {
                return Err(MeshViolation::Orientation { simplex: number });
            }
            judged.fingerprint.add(points.map(|p| SiteHash::of(&p)));
        }
        Ok(judged)
    }

    const BEYOND: Conflict = Conflict { is_inside: false, is_tie: false };
}

impl<const D: usize> Kind<D, 2, 1> for Chain {
    const FACETS: [[usize; 1]; 2] = [[1], [0]];

    fn judge(
        &self,
        _: &Job<'_, D>,
        sites: &TileSites<D>,
        simplices: &[[u32; 2]],
        _: &[[u32; 2]],
    ) -> Result<Judged, MeshViolation> {
        Self::judge(sites, simplices)
    }

    fn conflict(&self, _: &Job<'_, D>, _: &[[f64; D]; 2], _: &[f64; D]) -> Conflict {
        Self::BEYOND
    }
}

impl<const D: usize> Kind<D, 1, 0> for Chain {
    const FACETS: [[usize; 0]; 1] = [[]];

    fn judge(
        &self,
        _: &Job<'_, D>,
        sites: &TileSites<D>,
        simplices: &[[u32; 1]],
        _: &[[u32; 1]],
    ) -> Result<Judged, MeshViolation> {
        Self::judge(sites, simplices)
    }

    fn conflict(&self, _: &Job<'_, D>, _: &[[f64; D]; 1], _: &[f64; D]) -> Conflict {
        Self::BEYOND
    }
}

impl<const D: usize> Job<'_, D> {
    /// Judges all tiles. `W` = F + 3 + V + V·D.
    pub(super) fn run<K, H, const V: usize, const F: usize, const W: usize>(
        self,
        kind: K,
        hull: H,
    ) -> Result<TilesVerdict, TilesError>
    where
        K: Kind<D, V, F>,
        H: Hull<D, V, F>,
    {
        self.monitor.pass(2, self.manifest.sites);
        let coverage = Coverage::<D>::new(self.manifest.points, &self.temporary, self.shares.rows)?;
        let between = Between::<D, V, F, W>::new(&self.temporary, self.shares.between);
        let mut judge = Judge { job: &self, kind, hull, between, all: Totals::default() };
        let readers = Readers::new(&self, coverage, TileFile::simplices::<V>);
        let coverage = readers.read(&mut |parts| judge.tile(parts))?;
        let Judge { kind, mut hull, between, mut all, .. } = judge;
        self.monitor.pass(3, between.count());
        all.ties += between.check(
            |simplex, point| {
                kind.conflict(&self, &simplex.map(|p| self.ready(&p)), &self.ready(point))
            },
            |side| {
                all.hull += 1;
                let facet = K::FACETS[side.facet];
                hull.add(facet.map(|i| side.rows[i]), facet.map(|i| self.ready(&side.points[i])))
            },
            |sides| {
                self.monitor.points(sides);
                Ok(self.monitor.check()?)
            },
        )?;
        hull.check()?;
        let [owned, duplicates] = coverage.counts();
        let (source, temporary) = (self.source, &self.temporary);
        coverage.check(source, &self.overview, temporary, self.shares.sites, &self.monitor)?;
        self.conclude(&all, owned, duplicates)
    }

    /// Compares the counts of the manifest.
    fn conclude(
        &self,
        all: &Totals,
        owned: u64,
        duplicates: u64,
    ) -> Result<TilesVerdict, TilesError> {
        let Manifest { points, points_hash, sites, simplices, hull, .. } = *self.manifest;
        count("distinct points", sites, owned)?;
        count("duplicates", self.manifest.duplicates, duplicates)?;
        count("simplices", simplices, all.simplices)?;
        count("hull facets", hull, all.hull)?;
        if all.fingerprint != self.manifest.fingerprint {
            let (claimed, found) = (self.manifest.fingerprint, all.fingerprint);
            let place = "manifest.txt".to_owned();
            return Err(TilesViolation::Fingerprint { place, claimed, found }.into());
        }
        Ok(TilesVerdict {
            dimension: D as u8,
            hull_dimension: self.vertices.checked_sub(1).map(|dimension| dimension as u8),
            points,
            points_hash,
            tiles: self.manifest.tiles.len() as u64,
            counts: TriangulationCounts { sites, simplices, hull },
            duplicates,
            fingerprint: all.fingerprint,
            ties: all.ties,
        })
    }

    /// A point as determinants take it.
    fn ready(&self, p: &[f64; D]) -> [f64; D] {
        let p = self.overview.scaled(p);
        self.axes.map(|k| p[k])
    }
}

/// What all chunks add up to.
#[derive(Default)]
struct Totals {
    simplices: u64,
    hull: u64,
    ties: u64,
    fingerprint: Fingerprint,
}

/// What is known of the tile that is being judged.
struct Begun<const D: usize> {
    sites: Arc<TileSites<D>>,
    /// Simplices that were judged.
    first: u64,
    /// Links that were met.
    links: usize,
    hull: u64,
    fingerprint: Fingerprint,
}

struct Judge<'a, 'j, K, H, const D: usize, const V: usize, const F: usize, const W: usize> {
    job: &'a Job<'j, D>,
    kind: K,
    hull: H,
    between: Between<D, V, F, W>,
    all: Totals,
}

impl<K, H, const D: usize, const V: usize, const F: usize, const W: usize>
    Judge<'_, '_, K, H, D, V, F, W>
where
    K: Kind<D, V, F>,
    H: Hull<D, V, F>,
{
    fn tile(&mut self, parts: impl Iterator<Item = Part<D>>) -> Result<(), TilesError> {
        let mut begun: Option<Begun<D>> = None;
        for part in parts {
            self.job.monitor.check()?;
            match (part, &mut begun) {
                (Part::Tile(sites), begun) => {
                    for &[tile, code] in &sites.outside {
                        self.between.add_outside(u64::from(tile) << 32 | u64::from(code))?;
                    }
                    let (hull, fingerprint) = (sites.outside.len() as u64, Fingerprint::default());
                    *begun = Some(Begun { sites, first: 0, links: 0, hull, fingerprint });
                }
                (Part::Simplices(simplices, mut neighbors), Some(tile)) => {
                    let simplices = simplices.as_chunks().0;
                    self.simplices(tile, simplices, neighbors.as_chunks_mut().0)?;
                }
                (Part::End(counts), Some(tile)) => self.end(tile, &counts)?,
                (_, None) => {}
            }
        }
        Ok(())
    }

    fn simplices(
        &mut self,
        tile: &mut Begun<D>,
        simplices: &[[u32; V]],
        neighbors: &mut [[u32; V]],
    ) -> Result<(), TilesError> {
        if self.all.simplices == 0
            && let Some(simplex) = simplices.first()
        {
            let points = simplex.map(|v| self.job.ready(&tile.sites.coordinates[v as usize]));
            self.hull.begin(&points);
        }
        let first = tile.first;
        let chunk = first..first + simplices.len() as u64;
        for (number, (simplex, across)) in simplices.iter().zip(&mut *neighbors).enumerate() {
            for facet in 0..V {
                let neighbor = across[facet];
                if V > 2 && chunk.contains(&u64::from(neighbor)) {
                    across[facet] = neighbor - first as u32;
                } else {
                    across[facet] = NO_NEIGHBOR;
                    let simplex = (first as u32 + number as u32, simplex);
                    self.facet(tile, simplex, facet, neighbor)?;
                }
            }
        }
        let judged = self.kind.judge(self.job, &tile.sites, simplices, neighbors);
        let judged = judged.map_err(|violation| {
            let TileSites { tile, ref rows, .. } = *tile.sites;
            TilesViolation::of_chunk(&violation, tile, first, rows)
        })?;
        tile.fingerprint.merge(judged.fingerprint);
        tile.first = chunk.end;
        self.all.ties += judged.ties;
        self.all.simplices += simplices.len() as u64;
        Ok(())
    }

    /// A facet whose other side is not in the chunk.
    fn facet(
        &mut self,
        tile: &mut Begun<D>,
        (number, simplex): (u32, &[u32; V]),
        facet: usize,
        neighbor: u32,
    ) -> Result<(), TilesError> {
        let sites = &tile.sites;
        let rows = simplex.map(|v| sites.rows[v as usize]);
        let points = simplex.map(|v| sites.coordinates[v as usize]);
        let across = match neighbor {
            NO_NEIGHBOR => {
                // A single point has no facets, but must be the only one.
                let is_facet = u64::from(F > 0);
                tile.hull += is_facet;
                self.all.hull += is_facet;
                let facet = K::FACETS[facet];
                let points = facet.map(|i| self.job.ready(&points[i]));
                return self.hull.add(facet.map(|i| rows[i]), points);
            }
            // Counted it would be a facet of the hull.
            _ if F == 0 => {
                let (tile, simplex) = (sites.tile, u64::from(number));
                let problem = "a single point has no neighbor";
                return Err(TilesViolation::Neighbor { tile, simplex, facet, problem }.into());
            }
            OTHER_TILE => match sites.links.get(tile.links) {
                Some(&[code, other, there]) if code == number << 2 | facet as u32 => {
                    tile.links += 1;
                    Across::Link(u64::from(other) << 32 | u64::from(there))
                }
                _ => Across::LaterTile,
            },
            simplex => Across::Simplex(simplex),
        };
        self.between.add(&Side { tile: sites.tile, simplex: number, facet, points, rows, across })
    }

    fn end(&mut self, tile: &Begun<D>, counts: &Counts) -> Result<(), TilesError> {
        let place = || file_name(tile.sites.tile);
        if tile.links < tile.sites.links.len() {
            let [code, ..] = tile.sites.links[tile.links];
            let (simplex, facet) = (u64::from(code >> 2), code as usize & 3);
            let problem = "it has a link, but no neighbor in another tile";
            let tile = tile.sites.tile;
            return Err(TilesViolation::Neighbor { tile, simplex, facet, problem }.into());
        }
        if tile.hull != counts.hull {
            let (what, claimed, found) = ("hull facets", counts.hull, tile.hull);
            return Err(TilesViolation::Count { place: place(), what, claimed, found }.into());
        }
        if tile.fingerprint != counts.fingerprint {
            let (claimed, found) = (counts.fingerprint, tile.fingerprint);
            return Err(TilesViolation::Fingerprint { place: place(), claimed, found }.into());
        }
        self.all.fingerprint.merge(tile.fingerprint);
        self.job.monitor.points(counts.sites - counts.copies);
        Ok(())
    }
}
