//! The finished triangulation in memory, for walking around in.

use taut_points::{InputError, OrderBy, Points, Scalar, on_threads};

use crate::affine::{Span, apex, span_of_plane, span_of_space};
use crate::canonical::renumbered;
use crate::flat::star_of_apex;
use crate::geometry::{Geometry, InPlane, InSpace};
use crate::kernel::{Counters, Kernel};
use crate::plane::constrained::{Constrained, ConstraintError, Segment, constrain};
use crate::rounds::insert_all_in_parallel;
use crate::simplex::{GHOST, Simplex, Slots, decode};
use crate::sites::{Scale, Sites};
use crate::{DelaunayOptions, Error};

/// The Delaunay triangulation of points of the plane, and the ghosts that close it.
pub type Plane = Triangulation<2, 3>;

/// The Delaunay triangulation of points of space, and the ghosts that close it.
pub type Space = Triangulation<3, 4>;

/// The affine hull of the sites, and the simplices on it.
#[derive(Clone, Debug, PartialEq)]
pub enum Complex {
    /// There are no points.
    Nothing,
    /// All points are equal: one site.
    Point,
    /// All points are on a line: the sites along it, from the lexicographically smallest.
    Line(Vec<u32>),
    /// All points of space are on a plane: the triangles in it with their ghosts, all turning the same way.
    Flat(Slots<3>),
    /// The sites span all dimensions: [`Triangulation::slots`] has the simplices.
    Full,
}

/// The Delaunay triangulation of a set of points in the plane (`D = 2`, `V = 3`) or in space (`D = 3`, `V = 4`).
///
/// A *site* is a distinct point. Sites are numbered along a Hilbert curve, a numbering that depends on the point set
/// alone; [`row`](Self::row) gives the smallest input row of a site. Where more than D + 1 sites lie on a sphere, the
/// simplices are those of a perturbation that depends on coordinates alone, so the set of simplices is a function of the
/// point set. The numbers of simplices depend on how it was built, with several threads on which of them came first;
/// [`renumbered`](Self::renumbered) and [`solution`](Self::solution) put them in canonical order.
#[derive(Clone, Debug)]
pub struct Triangulation<const D: usize, const V: usize> {
    pub(crate) sites: Sites<D>,
    pub(crate) complex: Complex,
    pub(crate) slots: Slots<V>,
    pub(crate) counters: Counters,
    /// The way in which it was built, for the trace.
    pub(crate) method: &'static str,
}

impl Plane {
    /// Triangulates points of the plane.
    ///
    /// O(n log n) expected for any input with [`InsertionOrder::Random`](crate::InsertionOrder::Random); the default is
    /// no slower on any set of `bench delaunay plane plane-cliffs`, but has no such bound. About 70 bytes a point beyond
    /// the input on one thread and on two.
    ///
    /// # Errors
    /// [`Error::Input`] if points do not have two coordinates, [`Error::Input`],
    /// [`Error::TooManySimplices`], [`Error::Input`] when the monitor says so.
    pub fn build<T: Scalar>(
        points: &Points<'_, T>,
        options: &DelaunayOptions<'_>,
    ) -> Result<Self, Error> {
        build(points, "2, the plane", options, |sites| {
            Ok(match span_of_plane(&sites.coordinates) {
                Span::Nothing => Complex::Nothing.into(),
                Span::Point => Complex::Point.into(),
                Span::Line | Span::Plane(_) => Complex::Line(along_line(sites)).into(),
                Span::Full(start) => full::<2, 3, InPlane>(sites, start, options)?,
            })
        })
    }
}

impl Plane {
    /// The constrained Delaunay triangulation: with these segments between sites as edges, and Delaunay as far as they
    /// let it be. Triangles inside the rings that segments form are marked.
    ///
    /// A segment that is an edge already costs a look around one of its ends; one that crosses k edges O(k²) at worst.
    /// [`sites_of_rows`](Triangulation::sites_of_rows) translates from rows of the input.
    ///
    /// # Errors
    /// [`ConstraintError`] if segments cross where no site is, name sites that are not there, or rings do not close, and
    /// if the sites do not span the plane.
    pub fn constrained(&self, segments: &[Segment]) -> Result<Constrained, ConstraintError> {
        if !matches!(self.complex, Complex::Full) {
            return Err(ConstraintError::Flat);
        }
        let mut triangles = renumbered(&self.slots, self.site_count());
        let pieces = constrain(&self.sites.coordinates, &mut triangles, segments)?;
        Ok(Constrained::new(self.site_count(), triangles, pieces))
    }
}

impl Space {
    /// Triangulates points of space.
    ///
    /// O(n log n + simplices) expected with [`InsertionOrder::Random`](crate::InsertionOrder::Random), and in practice
    /// with the default. There are about 7n tetrahedra for points of a volume or of a surface, n²/2 at worst. About 260
    /// bytes a point of a volume beyond the input on one thread, 270 on two.
    ///
    /// # Errors
    /// [`Error::Input`] if points do not have three coordinates, [`Error::Input`],
    /// [`Error::TooManySimplices`], [`Error::Input`] when the monitor says so.
    pub fn build<T: Scalar>(
        points: &Points<'_, T>,
        options: &DelaunayOptions<'_>,
    ) -> Result<Self, Error> {
        build(points, "3, space", options, |sites| {
            Ok(match span_of_space(&sites.coordinates) {
                Span::Nothing => Complex::Nothing.into(),
                Span::Point => Complex::Point.into(),
                Span::Line => Complex::Line(along_line(sites)).into(),
                Span::Plane(on) => flat(sites, on, options)?,
                Span::Full(start) => full::<3, 4, InSpace>(sites, start, options)?,
            })
        })
    }
}

struct Built<const V: usize> {
    complex: Complex,
    slots: Slots<V>,
    counters: Counters,
}

impl<const V: usize> From<Complex> for Built<V> {
    /// No simplices, and no work worth counting.
    fn from(complex: Complex) -> Self {
        Self { complex, slots: Slots::default(), counters: Counters::default() }
    }
}

/// Checks, orders, and hands the sites to `complex` on a pool of the wanted size.
fn build<T: Scalar, const D: usize, const V: usize>(
    points: &Points<'_, T>,
    expected: &'static str,
    options: &DelaunayOptions<'_>,
    complex: impl FnOnce(&mut Sites<D>) -> Result<Built<V>, Error> + Send,
) -> Result<Triangulation<D, V>, Error> {
    if points.dim() != D {
        return Err(Error::Input(InputError::Dimension { dim: points.dim(), expected }));
    }
    let solve = || {
        options.monitor.pass(1, points.len() as u64);
        let mut sites = Sites::new(points, options.vectors, &options.monitor)?;
        let Built { complex, slots, counters } = complex(&mut sites)?;
        if sites.coordinates.is_empty() {
            sites.gather(points);
        }
        Ok(Triangulation { sites, complex, slots, counters, method: options.order.name() })
    };
    on_threads(options.threads, solve)
}

/// The sites of a line from end to end.
fn along_line<const D: usize>(sites: &Sites<D>) -> Vec<u32> {
    let mut chain: Vec<u32> = (0..sites.len() as u32).collect();
    let at = |i: u32| sites.coordinates[i as usize];
    chain.order_by(&|&a, &b| at(a).partial_cmp(&at(b)).unwrap_or(std::cmp::Ordering::Equal));
    chain
}

fn full<const D: usize, const V: usize, G: Geometry<D, V>>(
    sites: &mut Sites<D>,
    start: [u32; V],
    options: &DelaunayOptions<'_>,
) -> Result<Built<V>, Error> {
    // The kernel takes the coordinates, so that they are there once; what it does not give back is gathered again.
    let mut mesh = G::Mesh::new(std::mem::take(&mut sites.coordinates), sites.settings);
    mesh.start(start);
    insert_all_in_parallel(&mut mesh, &start, options, rayon::current_num_threads())?;
    let (simplices, coordinates, counters) = mesh.finish();
    sites.coordinates = coordinates.unwrap_or_default();
    Ok(Built { complex: Complex::Full, slots: Slots::of(simplices), counters })
}

/// Points of space on a plane: with one more point off it, all of whose neighbors are in it.
fn flat(sites: &Sites<3>, on: [u32; 3], options: &DelaunayOptions<'_>) -> Result<Built<4>, Error> {
    let top = sites.len() as u32;
    let mut coordinates = sites.coordinates.clone();
    coordinates.push(apex(&sites.coordinates, on));
    let start = [on[0], on[1], on[2], top];
    let mut mesh = <InSpace as Geometry<3, 4>>::Mesh::new(coordinates, sites.settings);
    mesh.start(start);
    insert_all_in_parallel(&mut mesh, &start, options, rayon::current_num_threads())?;
    let (simplices, _, counters) = mesh.finish();
    let triangles = Slots::of(star_of_apex(&simplices, top));
    Ok(Built { complex: Complex::Flat(triangles), slots: Slots::default(), counters })
}

impl<const D: usize, const V: usize> Triangulation<D, V> {
    /// Returns how many sites (distinct points) there are.
    pub fn site_count(&self) -> usize {
        self.sites.len()
    }

    /// The point of a site, as it was given (−0 as 0).
    ///
    /// # Panics
    /// If there is no such site.
    pub fn site(&self, site: u32) -> [f64; D] {
        let back = self.sites.scale.inverse();
        self.sites.coordinates[site as usize].map(|x| back.apply(x))
    }

    /// The smallest input row of a site.
    ///
    /// # Panics
    /// If there is no such site.
    pub fn row(&self, site: u32) -> u32 {
        self.sites.rows[site as usize]
    }

    /// For each input row its site.
    pub fn sites_of_rows(&self) -> Vec<u32> {
        let mut sites = vec![0; self.sites.rows.len() + self.sites.duplicates.len()];
        (0u32..).zip(&self.sites.rows).for_each(|(site, &row)| sites[row as usize] = site);
        // A duplicate comes after the row it equals.
        for &[row, first] in &self.sites.duplicates {
            sites[row as usize] = sites[first as usize];
        }
        sites
    }

    /// Input rows that equal an earlier row, each with the smallest row it equals; by row.
    pub fn duplicates(&self) -> &[[u32; 2]] {
        &self.sites.duplicates
    }

    /// Returns what the sites span, and the simplices there are if that is less than all dimensions.
    pub fn complex(&self) -> &Complex {
        &self.complex
    }

    /// The slots of simplices, ghosts included, by number; none if the sites do not span all dimensions. A slot may hold
    /// no simplex: [`simplices`](Self::simplices) and [`ghosts`](Self::ghosts) tell which do.
    pub fn slots(&self) -> &Slots<V> {
        &self.slots
    }

    /// The [`slots`](Self::slots) alone, in one array in which neighbors are found by their numbers. All else is given back.
    pub fn into_slots(self) -> Vec<Simplex<V>> {
        self.slots.into_array()
    }

    /// The same with its simplices numbered again, in canonical order, and ghosts after them: then all numbers are a function of
    /// the point set, and so is what is listed by them. O(simplices), and as much memory again while it works.
    pub fn renumbered(mut self) -> Self {
        let sites = self.site_count();
        self.slots = Slots::of(renumbered(&self.slots, sites));
        if let Complex::Flat(triangles) = &mut self.complex {
            *triangles = Slots::of(renumbered(triangles, sites));
        }
        self
    }

    /// The numbers of the finite simplices; none if the sites do not span all dimensions.
    pub fn simplices(&self) -> impl Iterator<Item = u32> {
        (0u32..)
            .zip(self.slots.iter())
            .filter(|(_, s)| s.is_live() && !s.is_ghost())
            .map(|(t, _)| t)
    }

    /// The numbers of the ghosts: one for each facet of the hull.
    pub fn ghosts(&self) -> impl Iterator<Item = u32> {
        (0u32..).zip(self.slots.iter()).filter(|(_, s)| s.is_live() && s.is_ghost()).map(|(t, _)| t)
    }

    /// The sites of a simplex in positive order; one of a ghost's is [`GHOST`].
    ///
    /// # Panics
    /// If there is no such slot.
    pub fn vertices(&self, simplex: u32) -> [u32; V] {
        self.slots[simplex as usize].vertices
    }

    /// The simplex across the facet opposite vertex `i`, and the place of the vertex opposite that facet in it.
    ///
    /// # Panics
    /// If there is no such slot or vertex.
    pub fn neighbor(&self, simplex: u32, i: usize) -> (u32, usize) {
        decode(self.slots[simplex as usize].neighbors[i])
    }

    /// The facets of the convex hull as sites: from outside, vertices are seen in counter-clockwise order in space; in
    /// the plane the set is to the left of each edge. None if the sites do not span all dimensions; the answer in
    /// [`solution`](Self::solution) has the hull of such sets.
    pub fn hull(&self) -> impl Iterator<Item = [u32; D]> {
        self.ghosts().map(|t| self.hull_facet(t))
    }

    /// The facet of the convex hull that a ghost stands for, as in [`hull`](Self::hull).
    ///
    /// # Panics
    /// If there is no such slot.
    pub fn hull_facet(&self, ghost: u32) -> [u32; D] {
        hull_facet(self.vertices(ghost))
    }

    /// Events of the build.
    pub fn counters(&self) -> &Counters {
        &self.counters
    }

    pub(crate) fn scale(&self) -> Scale {
        self.sites.scale
    }
}

/// The finite facet of a ghost, turned outward.
pub(crate) fn hull_facet<const D: usize, const V: usize>(vertices: [u32; V]) -> [u32; D] {
    let apex = vertices.iter().position(|&v| v == GHOST).unwrap_or(0);
    let mut facet: [u32; D] = std::array::from_fn(|k| vertices[(apex + 1 + k) % V]);
    // (facet, infinity) is the ghost turned by apex + 1 places. In space it is positive, and the facet counter-clockwise
    // from outside, if that number is even; in the plane it is positive always, with infinity to the left of the edge.
    if D == 2 || apex % 2 == 0 {
        facet.swap(0, 1);
    }
    facet
}
