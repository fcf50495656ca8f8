//! Triangles that were found elsewhere, with what a checker needs to judge them.
//!
//! *Idea.* A checker proves topology and embedding from the triangles alone. That a triangle has an empty ball it proves only
//! where the ball is named: the Delaunay triangulation of the points names one for each triangle that is a facet of it.
//! *Guarantee.* Triangles stay as they are: none is turned, moved or left out.
//! *Trap.* Of more than four points on an empty sphere there are several Delaunay triangulations: a triangle of another one than that of
//! `taut-delaunay` is said to have no ball, although it has one.

use taut_certify::{Solution, Surface, SurfaceCertificate, SurfaceMethod, SurfaceMode, Trace};
use taut_delaunay::{Complex, DelaunayOptions, Space};
use taut_mesh::{TriangleMesh, self_intersections, topology};
use taut_points::{InputError, Monitor, PointSource, Points, hash_points};

use super::answer::{Facets, Sites, numbers, unused};
use super::cells::Cells;
use super::witness::{located, witnesses};
use super::{check_dim, read};
use crate::{Error, Span};

/// Returns triangles on the rows of `source` as a surface with its certificate, as they stand.
///
/// Of equal rows the first stands for all. Balls are named where every triangle is a Delaunay facet. Of a manifold that meets
/// itself nowhere it is claimed that closed parts face outwards, which is for a checker to accept or refuse.
///
/// ```
/// use taut_points::{Monitor, Points};
/// use taut_reconstruct::given_surface;
///
/// let corners = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
/// let points = Points::new(&corners, 3)?;
/// let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let found = given_surface(&points, &triangles, &Monitor::silent())?;
/// assert!(found.check(&points)?.is_sound);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::Input`], also of a triangle that names no row; [`Error::Triangulation`] for more cells than can be numbered.
pub fn given_surface(
    source: &dyn PointSource,
    triangles: &[[u32; 3]],
    monitor: &Monitor<'_>,
) -> Result<Solution<Surface>, Error> {
    check_dim(source)?;
    if let Some(&row) = triangles.as_flattened().iter().find(|&&row| u64::from(row) >= source.len())
    {
        let (value, expected) = (row.to_string(), "rows of the points");
        return Err(Error::Input(InputError::Option { name: "triangles", value, expected }));
    }
    let given = read(source)?;
    let points_hash = hash_points(source, monitor)?;
    let view = Points::new(given.as_flattened(), 3);
    let Ok(view) = view else { return Err(Error::Flat { points: 0, span: Span::Nothing }) };
    let how = DelaunayOptions { monitor: *monitor, ..DelaunayOptions::default() };
    let space = Space::build(&view, &how)?.renumbered();
    let sites = Sites::of(&space, None);
    let triangles = on_sites(triangles, &space, given.len());
    let spans = matches!(space.complex(), Complex::Full);
    let cells = spans.then(|| Cells::of(space.into_slots(), sites.points.len()));
    monitor.check()?;

    let refused = |_| {
        let (points, most) = (triangles.len() as u64, u64::from(u32::MAX / 6));
        Error::Input(InputError::TooManyPoints { points, most })
    };
    let mesh = TriangleMesh::new(sites.exact(), &triangles).map_err(refused)?;
    let known = cells.as_ref().map(|cells| located(cells, &triangles, sites.points.len()));
    let apexes = match (&cells, known) {
        (Some(cells), Some(known)) if known.len() == triangles.len() => {
            witnesses(cells, sites.exact(), &known, |site| sites.row(site))
        }
        _ => Vec::new(),
    };
    let found = topology(&mesh);
    let embedded = !apexes.is_empty() || self_intersections(&mesh).is_embedded();
    let outward = embedded && found.is_manifold() && found.is_oriented();
    let facets = Facets { triangles, ..Facets::default() };
    let unused = unused(&facets, &sites, false);
    let rows = |triangle: &[u32; 3]| triangle.map(|site| sites.row(site));
    let triangles = facets.triangles.iter().map(rows).collect();
    let answer = Surface { vertices: vec![], triangles, topology: numbers(&found), unused };
    let certificate = SurfaceCertificate {
        method: SurfaceMethod::Hull,
        mode: SurfaceMode::Open,
        apexes,
        embedded,
        outward,
        displacement: 0.0,
        doubts: vec![],
        points_hash,
    };
    let trace = Trace { method: "given".to_owned(), passes: 1, ..Trace::default() };
    Ok(Solution { answer, certificate, trace })
}

/// Triangles of rows as triangles of sites.
fn on_sites(triangles: &[[u32; 3]], space: &Space, rows: usize) -> Vec<[u32; 3]> {
    let mut site_of = vec![0; rows];
    for site in 0..space.site_count() as u32 {
        site_of[space.row(site) as usize] = site;
    }
    for &[copy, first] in space.duplicates() {
        site_of[copy as usize] = site_of[first as usize];
    }
    triangles.iter().map(|triangle| triangle.map(|row| site_of[row as usize])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{SurfaceOptions, surface};
    use taut_certify::{CheckError, SurfaceDoubt, SurfaceViolation, Violation};

    const OCTAHEDRON: [[f64; 3]; 6] = [
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, 1.5, 0.0],
        [0.0, -1.5, 0.0],
        [0.0, 0.0, 2.0],
        [0.0, 0.0, -2.0],
    ];

    fn given(points: &[[f64; 3]], triangles: &[[u32; 3]]) -> Solution<Surface> {
        let points = Points::new(points.as_flattened(), 3).unwrap();
        given_surface(&points, triangles, &Monitor::silent()).unwrap()
    }

    #[test]
    fn what_the_solver_found_is_sound_again() {
        let points = Points::new(OCTAHEDRON.as_flattened(), 3).unwrap();
        let found = surface(&points, &SurfaceOptions::default()).unwrap();
        let again = given(&OCTAHEDRON, &found.answer.triangles);
        assert_eq!(again.answer, found.answer);
        let verdict = again.check(&points).unwrap();
        assert!(verdict.is_sound && verdict.is_delaunay && verdict.is_closed);
    }

    #[test]
    fn triangles_inside_out_are_not_turned() {
        let points = Points::new(OCTAHEDRON.as_flattened(), 3).unwrap();
        let found = surface(&points, &SurfaceOptions::default()).unwrap();
        let turned: Vec<[u32; 3]> =
            found.answer.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        let mut again = given(&OCTAHEDRON, &turned);
        assert_eq!(again.answer.triangles, turned);
        let refused = again.check(&points).unwrap_err();
        assert!(matches!(
            refused,
            CheckError::Rejected(Violation::Surface(SurfaceViolation::NotOutward { .. }))
        ));
        again.certificate.outward = false;
        assert!(matches!(
            again.check(&points).unwrap().doubt,
            Some(SurfaceDoubt::Inward { component: 0, depth: 0 })
        ));
    }

    #[test]
    fn triangles_that_meet_or_have_no_ball_are_told() {
        // Two triangles through each other.
        let places = [
            [-1.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.25, -1.0],
            [0.0, 0.25, 1.0],
            [0.0, 2.0, 0.5],
        ];
        let found = given(&places, &[[0, 1, 2], [3, 4, 5]]);
        assert!(!found.certificate.embedded && found.certificate.apexes.is_empty());
        let points = Points::new(places.as_flattened(), 3).unwrap();
        let verdict = found.check(&points).unwrap();
        assert!(!verdict.is_embedded && !verdict.is_delaunay && verdict.is_manifold);
    }

    #[test]
    fn copies_of_a_place_are_one_vertex() {
        let mut places = OCTAHEDRON[..4].to_vec();
        places[3] = [0.0, 0.0, 1.0];
        let soup: Vec<[f64; 3]> =
            [0, 1, 2, 0, 1, 3, 0, 2, 3, 1, 2, 3].map(|k: usize| places[k]).to_vec();
        let found = given(&soup, &[[0, 1, 2], [3, 5, 4], [6, 7, 8], [9, 11, 10]]);
        assert_eq!(found.answer.topology.vertices, 4);
        assert_eq!(found.answer.unused.duplicates.len(), 8);
        let points = Points::new(soup.as_flattened(), 3).unwrap();
        let mut withdrawn = found.clone();
        withdrawn.certificate.outward = false;
        assert!(found.check(&points).is_ok() || withdrawn.check(&points).is_ok());
        assert!(given_surface(&points, &[[0, 1, 12]], &Monitor::silent()).is_err());
    }
}
