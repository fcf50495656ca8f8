//! The distributions, their names and their parameters.

use std::fmt;

use crate::{Error, shown_number};

/// From what points are drawn, independently of each other.
///
/// Shapes of the plane or of space are cut or filled up to the dimension: what a point of theirs lacks is 0.
/// It is displayed as `taut generate` wants it.
///
/// ```
/// use taut_points::Distribution;
/// assert_eq!(Distribution::Shell { thickness: 1e-8 }.to_string(), "shell --thickness 1e-8");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Distribution {
    /// Uniform in the unit cube [0, 1)ᵈ.
    Uniform,
    /// Uniform on the 2ᵈ vertices of the unit cube: cospherical, and with duplicates in low dimension.
    CubeVertices,
    /// Each coordinate standard normal.
    Normal,
    /// Each coordinate Poisson distributed with λ = 1: a lattice, with many ties.
    Poisson,
    /// Uniform on the unit sphere, to rounding.
    Sphere,
    /// Uniform direction, distance from the origin uniform in [1 − t, 1 + t).
    Shell {
        /// Half the thickness t ≥ 0; 1e-8 makes the hardest instances for a minimum enclosing ball.
        thickness: f64,
    },
    /// Normal clouds around centers that are uniform in the unit cube; point i belongs to cloud i mod count.
    Clusters {
        /// Number of clouds, at least 1.
        count: u64,
        /// Standard deviation of each cloud, ≥ 0.
        spread: f64,
    },
    /// As clusters, but each cloud has a standard deviation of its own, 10^u with u uniform in [−5, −2): densities
    /// that differ by many orders of magnitude.
    Clouds {
        /// Number of clouds, at least 1.
        count: u64,
    },
    /// The d + 1 vertices of a regular simplex with unit edges, then points uniform inside it.
    Simplex,
    /// n points at equal angles on the unit circle in the first two coordinates; the others are 0.
    Polygon {
        /// Number of vertices of the polygon, at least 1; point i is vertex i mod vertices.
        vertices: u64,
    },
    /// Uniform direction; the distance from the origin has the distribution function 1 − 1/√(1 + r²), that of the
    /// stars of a flat galaxy after Kuzmin: dense in the middle, with points far out.
    Kuzmin,
    /// The integer points 0 … side − 1 along each axis, each once before any comes again, in random order. Where sideᵈ
    /// is beyond 2⁶⁴ the last coordinates stay 0.
    Grid {
        /// Points along an axis, from 1 to 2⁵³.
        side: u64,
        /// Degrees by which the grid is turned in the plane of the first two coordinates; then its points are on
        /// lines and circles to rounding only.
        angle: f64,
    },
    /// Along a spiral of Archimedes in the plane, r = φ / (2π·turns), from the origin to distance 1; r² is uniform,
    /// which is nearly uniform in length.
    Spiral {
        /// The number of turns, ≥ 0.
        turns: f64,
    },
    /// Two parallel segments of the plane: x uniform in [0, 1), y = i mod 2.
    Lines,
    /// Two segments of space on skew lines, by turns (t, 0, −1) and (0, t, 1) with t uniform in [−1, 1): n/2 points on
    /// each have (n/2 − 1)² Delaunay tetrahedra, as many as n points can.
    Skew,
    /// Points of a line and one beside it: (½, 1), then (x, 0) with x uniform in [0, 1). All triangles share a vertex.
    Fan,
    /// Roads of a map 60 units wide, as random walks: 50 points each, turning a little at every step, beginning near
    /// towns whose sizes follow Zipf's law, in one of four directions, rounded to multiples of 10⁻⁶.
    Roads {
        /// Number of towns, at least 1.
        count: u64,
    },
    /// On the torus of space with radii 2 and 0.7, uniform in both angles, each coordinate off by normal noise.
    Torus {
        /// Standard deviation of the noise, ≥ 0.
        noise: f64,
    },
}

/// The parameters of a distribution that is given by its name; what is left out has its default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Parameters {
    /// Half the thickness of a shell, at least 0. Default 0.1.
    pub thickness: Option<f64>,
    /// Number of clusters, clouds or towns of roads, at least 1. Default for n points: 5; √n / 4, at least 10;
    /// √(n / 50), at least 8.
    pub count: Option<u64>,
    /// Standard deviation of a cluster, at least 0. Default 0.05.
    pub spread: Option<f64>,
    /// Vertices of a polygon, at least 1. Default: as many as points.
    pub vertices: Option<u64>,
    /// Points along an axis of a grid, from 1 to 2⁵³. Default: the fewest that make a grid of n points.
    pub side: Option<u64>,
    /// Degrees by which a grid is turned. Default 0.
    pub angle: Option<f64>,
    /// The number of turns of a spiral, at least 0. Default 10.
    pub turns: Option<f64>,
    /// Standard deviation of the noise of a torus, at least 0. Default 1e-4.
    pub noise: Option<f64>,
}

impl Distribution {
    /// The name of each distribution, and a line about it.
    pub const NAMES: [(&str, &str); 18] = [
        ("normal", "each coordinate standard normal"),
        ("uniform", "uniform in the unit cube"),
        ("cube", "vertices of the unit cube: cospherical, with duplicates in low dimension"),
        ("poisson", "each coordinate Poisson with mean 1: a lattice with many ties"),
        ("sphere", "uniform on the unit sphere"),
        ("shell", "uniform in direction, 1 ± T from the origin"),
        ("clusters", "normal clouds around K centers in the unit cube"),
        ("clouds", "the same, but of widths from 1e-5 to 1e-2"),
        ("simplex", "vertices of a regular simplex with unit edges, then points inside"),
        ("polygon", "K points at equal angles on the unit circle, in turn"),
        ("kuzmin", "stars of a flat galaxy: dense in the middle, with points far out"),
        ("grid", "integer grid of side K in random order, turned by DEGREES"),
        ("spiral", "a spiral of Archimedes with T turns, in the plane"),
        ("lines", "two parallel segments, in the plane"),
        ("skew", "two segments on skew lines, in space"),
        ("fan", "one point beside a segment, then points of the segment, in the plane"),
        ("roads", "random walks around K towns, rounded to 1e-6, in the plane"),
        ("torus", "a torus with noise, in space"),
    ];

    /// The distribution of a name out of [`NAMES`](Self::NAMES), for n points of dimension `dim`.
    ///
    /// ```
    /// use taut_points::{Distribution, generate::Parameters};
    /// let given = Parameters { count: Some(3), ..Default::default() };
    /// let clusters = Distribution::named("clusters", 100, 2, &given)?;
    /// assert_eq!(clusters, Distribution::Clusters { count: 3, spread: 0.05 });
    /// # Ok::<(), taut_points::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Parameter`] for another name or a parameter out of range, [`Error::Foreign`] for a parameter that the
    /// distribution does not take.
    pub fn named(name: &str, n: u64, dim: usize, given: &Parameters) -> Result<Self, Error> {
        for (parameter, is_given, owner) in [
            ("thickness", given.thickness.is_some(), "shell"),
            ("count", given.count.is_some(), "clusters, clouds and roads"),
            ("spread", given.spread.is_some(), "clusters"),
            ("vertices", given.vertices.is_some(), "polygon"),
            ("side", given.side.is_some(), "grid"),
            ("angle", given.angle.is_some(), "grid"),
            ("turns", given.turns.is_some(), "spiral"),
            ("noise", given.noise.is_some(), "torus"),
        ] {
            if is_given && !owner.split([',', ' ']).any(|owner| owner == name) {
                let distribution = name.to_owned();
                return Err(Error::Foreign { name: parameter, owner, distribution });
            }
        }
        let found = match name {
            "normal" => Distribution::Normal,
            "uniform" => Distribution::Uniform,
            "cube" => Distribution::CubeVertices,
            "poisson" => Distribution::Poisson,
            "sphere" => Distribution::Sphere,
            "shell" => Distribution::Shell { thickness: given.thickness.unwrap_or(0.1) },
            "clusters" => Distribution::Clusters {
                count: given.count.unwrap_or(5),
                spread: given.spread.unwrap_or(0.05),
            },
            "clouds" => {
                Distribution::Clouds { count: given.count.unwrap_or((n / 16).isqrt().max(10)) }
            }
            "simplex" => Distribution::Simplex,
            "polygon" => Distribution::Polygon { vertices: given.vertices.unwrap_or(n.max(1)) },
            "kuzmin" => Distribution::Kuzmin,
            "grid" => Distribution::Grid {
                side: given.side.unwrap_or_else(|| side(n, dim)),
                angle: given.angle.unwrap_or(0.0),
            },
            "spiral" => Distribution::Spiral { turns: given.turns.unwrap_or(10.0) },
            "lines" => Distribution::Lines,
            "skew" => Distribution::Skew,
            "fan" => Distribution::Fan,
            "roads" => {
                Distribution::Roads { count: given.count.unwrap_or((n / 50).isqrt().max(8)) }
            }
            "torus" => Distribution::Torus { noise: given.noise.unwrap_or(1e-4) },
            _ => {
                return Err(Error::Parameter {
                    name: "distribution",
                    value: name.to_owned(),
                    expected: "normal, uniform, cube, poisson, sphere, shell, clusters, clouds, simplex, polygon, \
                               kuzmin, grid, spiral, lines, skew, fan, roads or torus",
                });
            }
        };
        found.check().map(|()| found)
    }

    /// Refuses parameters out of range.
    pub(super) fn check(&self) -> Result<(), Error> {
        let finite = |name, value: f64| match value.is_finite() {
            true => Ok(()),
            false => Err((name, shown_number(value), "a finite number")),
        };
        let size = |name, value: f64| match value >= 0.0 && value.is_finite() {
            true => Ok(()),
            false => Err((name, shown_number(value), "a finite number, at least 0")),
        };
        let positive = |name, value: u64| match value {
            0 => Err((name, "0".to_owned(), "at least 1")),
            _ => Ok(()),
        };
        match *self {
            Distribution::Shell { thickness } => size("thickness", thickness),
            Distribution::Clusters { count, spread } => {
                positive("count", count).and_then(|()| size("spread", spread))
            }
            Distribution::Clouds { count } | Distribution::Roads { count } => {
                positive("count", count)
            }
            Distribution::Polygon { vertices } => positive("vertices", vertices),
            Distribution::Grid { side, .. } if !(1..=SIDE_MAX).contains(&side) => {
                Err(("side", side.to_string(), "from 1 to 2^53"))
            }
            Distribution::Grid { angle, .. } => finite("angle", angle),
            Distribution::Spiral { turns } => size("turns", turns),
            Distribution::Torus { noise } => size("noise", noise),
            _ => Ok(()),
        }
        .map_err(|(name, value, expected)| Error::Parameter { name, value, expected })
    }
}

impl fmt::Display for Distribution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // `{:?}` writes 1e-8 where `{}` writes all its zeros.
        match *self {
            Distribution::Uniform => write!(f, "uniform"),
            Distribution::CubeVertices => write!(f, "cube"),
            Distribution::Normal => write!(f, "normal"),
            Distribution::Poisson => write!(f, "poisson"),
            Distribution::Sphere => write!(f, "sphere"),
            Distribution::Shell { thickness } => write!(f, "shell --thickness {thickness:?}"),
            Distribution::Clusters { count, spread } => {
                write!(f, "clusters --count {count} --spread {spread:?}")
            }
            Distribution::Clouds { count } => write!(f, "clouds --count {count}"),
            Distribution::Simplex => write!(f, "simplex"),
            Distribution::Polygon { vertices } => write!(f, "polygon --vertices {vertices}"),
            Distribution::Kuzmin => write!(f, "kuzmin"),
            Distribution::Grid { side, angle: 0.0 } => write!(f, "grid --side {side}"),
            Distribution::Grid { side, angle } => write!(f, "grid --side {side} --angle {angle:?}"),
            Distribution::Spiral { turns } => write!(f, "spiral --turns {turns:?}"),
            Distribution::Lines => write!(f, "lines"),
            Distribution::Skew => write!(f, "skew"),
            Distribution::Fan => write!(f, "fan"),
            Distribution::Roads { count } => write!(f, "roads --count {count}"),
            Distribution::Torus { noise } => write!(f, "torus --noise {noise:?}"),
        }
    }
}

/// The longest side of a grid: its coordinates are exact.
const SIDE_MAX: u64 = 1 << 53;

/// The least side of a grid of dimension `dim` with at least n points.
fn side(n: u64, dim: usize) -> u64 {
    let holds = |side: u64| {
        let exponent = u32::try_from(dim.max(1)).unwrap_or(u32::MAX);
        side.checked_pow(exponent).is_none_or(|points| points >= n)
    };
    // Rounding may leave the root one off in either direction.
    let mut least = ((n as f64).powf(1.0 / dim.max(1) as f64) as u64).clamp(2, SIDE_MAX) - 1;
    while least < SIDE_MAX && !holds(least) {
        least += 1;
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_has_the_least_side_that_holds_all_points() {
        for (n, dim, least) in [
            (0, 2, 1),
            (1, 3, 1),
            (1_000_000, 2, 1000),
            (1_000_001, 2, 1001),
            (999_999, 2, 1000),
            (1_000_000, 3, 100),
            (970_299, 3, 99),
            (970_300, 3, 100),
            (12, 300, 2),
            (7, 1, 7),
            (u64::MAX, 1, SIDE_MAX),
            (u64::MAX, 2, 1 << 32),
            (5, usize::MAX, 2),
        ] {
            assert_eq!(side(n, dim), least, "{n} points, d = {dim}");
        }
    }

    #[test]
    fn parameters_out_of_range_are_named() {
        let named = |name, given: &Parameters| Distribution::named(name, 1, 2, given);
        assert!(named("shell", &Parameters::default()).is_ok());
        let thin = Parameters { thickness: Some(-1.0), ..Default::default() };
        let wrong = named("shell", &thin).unwrap_err();
        assert_eq!(wrong.to_string(), "`thickness` is -1: expected a finite number, at least 0");
        let wrong = named("normal", &thin).unwrap_err();
        let said = "`thickness` belongs to shell, not to normal: leave it out";
        assert_eq!(wrong.to_string(), said);
        let none = Parameters { count: Some(0), ..Default::default() };
        for name in ["clusters", "clouds", "roads"] {
            assert_eq!(
                named(name, &none).unwrap_err().to_string(),
                "`count` is 0: expected at least 1"
            );
        }
        let said = "`count` belongs to clusters, clouds and roads, not to and: leave it out";
        assert_ne!(named("and", &none).unwrap_err().to_string(), said);
        for (name, given) in [
            ("grid", Parameters { side: Some(0), ..Default::default() }),
            ("grid", Parameters { side: Some(SIDE_MAX + 1), ..Default::default() }),
            ("grid", Parameters { angle: Some(f64::INFINITY), ..Default::default() }),
            ("spiral", Parameters { turns: Some(f64::NAN), ..Default::default() }),
            ("torus", Parameters { noise: Some(-1e-4), ..Default::default() }),
        ] {
            assert!(matches!(named(name, &given), Err(Error::Parameter { .. })), "{given:?}");
            assert!(matches!(named("normal", &given), Err(Error::Foreign { .. })), "{given:?}");
        }
    }

    #[test]
    fn each_name_is_a_distribution_of_its_own_and_is_displayed_first() {
        let named = |name| Distribution::named(name, 6, 2, &Parameters::default());
        let refused = named("weibull").unwrap_err().to_string();
        let mut found = Vec::new();
        for (name, _) in Distribution::NAMES {
            let distribution = named(name).unwrap();
            assert!(!found.contains(&distribution) && refused.contains(name), "{name}");
            assert_eq!(distribution.to_string().split(' ').next(), Some(name));
            found.push(distribution);
        }
        assert_eq!(found[9], Distribution::Polygon { vertices: 6 });
        assert_eq!(found[11].to_string(), "grid --side 3");
        let tilted = Distribution::Grid { side: 3, angle: 0.5 };
        assert_eq!(tilted.to_string(), "grid --side 3 --angle 0.5");
    }
}
