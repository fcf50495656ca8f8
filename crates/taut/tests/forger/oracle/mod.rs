//! The oracles: each decides, by exact arithmetic, whether what a checker let pass is true.

pub mod ball;
pub mod bodies;
mod body;
pub mod centers;
pub mod circle;
mod claims;
pub mod convex;
pub mod curve;
pub mod dop;
pub mod dyadic;
pub mod ellipse;
pub mod ellipsoid;
pub mod enclosing;
mod exchange;
pub mod files;
mod flat;
pub mod inscribed;
mod interval;
pub mod kernel_ball;
mod lattice;
mod linear;
mod mvee;
mod mvie;
mod numbers;
pub mod order;
pub mod oriented;
pub mod rectangle;
pub mod robust;
pub mod shapes;
pub mod surface;
pub mod triangle;
pub mod triangulation;

use std::collections::BTreeMap;

use taut::AnySolution;
use taut::certify::{AnyVerdict, EllipsoidVerdict, RobustVerdict};

use self::ball::BallOracle;
use self::bodies::BodiesOracle;
use self::centers::CentersOracle;
use self::circle::CircleOracle;
use self::convex::ConvexOracle;
use self::curve::CurveOracle;
use self::dop::DopOracle;
use self::ellipse::EllipseOracle;
use self::ellipsoid::EllipsoidOracle;
use self::inscribed::InscribedOracle;
use self::kernel_ball::KernelBallOracle;
use self::order::OrderOracle;
use self::oriented::OrientedOracle;
use self::rectangle::RectangleOracle;
use self::robust::RobustOracle;
use self::surface::SurfaceOracle;
use self::triangle::TriangleOracle;
use self::triangulation::TriangulationOracle;

use crate::cases::Input;
/// The statements of an oracle about an accepted answer and of every field of its verdict.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Truth {
    /// Every claim is true.
    True,
    /// A claim is false, and why.
    False(String),
    /// The oracle cannot decide, and why. This must be rare.
    Undecided(String),
}

impl Truth {
    /// Combines two findings: false beats undecided, and that beats true.
    pub fn and(self, other: impl FnOnce() -> Truth) -> Truth {
        match self {
            Truth::False(_) => self,
            Truth::True => other(),
            Truth::Undecided(_) => match other() {
                found @ Truth::False(_) => found,
                _ => self,
            },
        }
    }

    /// Returns `True`, or `False` for the reason given.
    pub fn claim(holds: bool, reason: impl FnOnce() -> String) -> Truth {
        if holds { Truth::True } else { Truth::False(reason()) }
    }
}

/// The oracles of one input: each finds the truth once, when it is asked for the first time.
pub struct CaseOracle<'a> {
    input: &'a Input,
    balls: BTreeMap<u8, BallOracle>,
    bodies: Option<BodiesOracle>,
    centers: Option<CentersOracle>,
    circle: Option<CircleOracle>,
    convex: Option<ConvexOracle>,
    curve: Option<CurveOracle>,
    dop: Option<DopOracle>,
    ellipse: Option<EllipseOracle>,
    ellipsoids: BTreeMap<u8, EllipsoidOracle>,
    inscribed: Option<InscribedOracle>,
    kernel_ball: Option<KernelBallOracle>,
    order: Option<OrderOracle>,
    oriented: Option<OrientedOracle>,
    rectangle: Option<RectangleOracle>,
    robust: Option<RobustOracle>,
    surface: Option<SurfaceOracle>,
    triangle: Option<TriangleOracle>,
    triangulation: Option<TriangulationOracle>,
}

/// A verified bracket of an optimum.
pub struct Interval {
    /// Which optimum, of all that one input has.
    pub optimum: String,
    /// Its lower bound.
    pub lower: f64,
    /// Its upper bound.
    pub upper: f64,
}

impl<'a> CaseOracle<'a> {
    /// Prepares to judge answers for the input.
    pub fn new(input: &'a Input) -> Self {
        CaseOracle {
            input,
            balls: BTreeMap::new(),
            bodies: None,
            centers: None,
            circle: None,
            convex: None,
            curve: None,
            dop: None,
            ellipse: None,
            ellipsoids: BTreeMap::new(),
            inscribed: None,
            kernel_ball: None,
            order: None,
            oriented: None,
            rectangle: None,
            robust: None,
            surface: None,
            triangle: None,
            triangulation: None,
        }
    }

    /// Judges every claim of an answer that the checker let pass.
    pub fn judge(&mut self, solution: &AnySolution, verdict: &AnyVerdict) -> Truth {
        let Input { values, columns, is_single, .. } = self.input;
        match (solution, verdict) {
            (AnySolution::Ball(found), AnyVerdict::Ball(verdict)) => {
                let items = found.certificate.items;
                let oracle = self
                    .balls
                    .entry(items as u8)
                    .or_insert_with(|| BallOracle::new(values, *columns, items));
                oracle.judge(found, verdict)
            }
            (AnySolution::Centers(found), AnyVerdict::Centers(verdict)) => {
                let oracle =
                    self.centers.get_or_insert_with(|| CentersOracle::new(values, *columns));
                oracle.judge(found, verdict)
            }
            (AnySolution::Bodies(found), AnyVerdict::Bodies(verdict)) => {
                let oracle = self.bodies.get_or_insert_with(|| BodiesOracle::new(values, *columns));
                oracle.judge(found, verdict)
            }
            (AnySolution::Circle(found), AnyVerdict::Circle(verdict)) => {
                let oracle = self.circle.get_or_insert_with(|| CircleOracle::new(values, *columns));
                oracle.judge(found, verdict)
            }
            (AnySolution::Convex(found), AnyVerdict::Convex(verdict)) => {
                let oracle = self.convex.get_or_insert_with(|| ConvexOracle::new(values, *columns));
                oracle.judge(found, verdict)
            }
            (AnySolution::Curve(found), AnyVerdict::Curve(verdict)) => {
                let oracle = self.curve.get_or_insert_with(|| CurveOracle::new(values, *columns));
                oracle.judge(found, verdict)
            }
            (AnySolution::Dop(found), AnyVerdict::Dop(verdict)) => {
                let oracle = self.dop.get_or_insert_with(|| DopOracle::new(values, *columns));
                oracle.judge(found, verdict)
            }
            (AnySolution::Ellipse(found), AnyVerdict::Ellipse(verdict)) => {
                let oracle =
                    self.ellipse.get_or_insert_with(|| EllipseOracle::new(values, *columns));
                oracle.judge(found, verdict)
            }
            (AnySolution::Ellipsoid(found), AnyVerdict::Ellipsoid(verdict)) => {
                let items = found.certificate.items;
                let oracle = self.ellipsoids.entry(items as u8).or_insert_with(|| {
                    EllipsoidOracle::new(values, *columns, items).in_precision(*is_single)
                });
                oracle.judge(found, &finite(verdict))
            }
            (AnySolution::Inscribed(found), AnyVerdict::Inscribed(verdict)) => {
                let oracle =
                    self.inscribed.get_or_insert_with(|| InscribedOracle::new(values, *columns));
                let mut verdict = *verdict;
                verdict.upper = verdict.upper.min(f64::MAX);
                verdict.gap = verdict.gap.min(f64::MAX);
                oracle.judge(found, &verdict)
            }
            (AnySolution::KernelBall(found), AnyVerdict::KernelBall(verdict)) => {
                let oracle =
                    self.kernel_ball.get_or_insert_with(|| KernelBallOracle::new(values, *columns));
                oracle.judge(found, verdict)
            }
            (AnySolution::Order(found), AnyVerdict::Order(verdict)) => {
                let oracle = self.order.get_or_insert_with(|| OrderOracle::new(values, *columns));
                oracle.judge(found, verdict)
            }
            (AnySolution::Surface(found), AnyVerdict::Surface(verdict)) => {
                let oracle =
                    self.surface.get_or_insert_with(|| SurfaceOracle::new(values, *columns));
                oracle.judge(found, verdict)
            }
            (AnySolution::Triangle(found), AnyVerdict::Triangle(verdict)) => {
                let oracle =
                    self.triangle.get_or_insert_with(|| TriangleOracle::new(values, *columns));
                oracle.judge(found, verdict)
            }
            (AnySolution::Triangulation(found), AnyVerdict::Triangulation(verdict)) => {
                let oracle = self
                    .triangulation
                    .get_or_insert_with(|| TriangulationOracle::new(values, *columns));
                oracle.judge(found, verdict)
            }
            (AnySolution::OrientedRectangle(found), AnyVerdict::OrientedRectangle(verdict)) => {
                let oracle =
                    self.oriented.get_or_insert_with(|| OrientedOracle::new(values, *columns));
                oracle.judge(found, verdict)
            }
            (AnySolution::Rectangle(found), AnyVerdict::Rectangle(verdict)) => {
                let oracle =
                    self.rectangle.get_or_insert_with(|| RectangleOracle::new(values, *columns));
                oracle.judge(found, verdict)
            }
            (AnySolution::Robust(found), AnyVerdict::Robust(verdict)) => {
                let oracle = self.robust.get_or_insert_with(|| RobustOracle::new(values, *columns));
                let enclosure = verdict.enclosure.map(|enclosure| finite(&enclosure));
                oracle.judge(found, &RobustVerdict { enclosure, ..*verdict })
            }
            _ => Truth::False("the verdict is of another kind than the answer".into()),
        }
    }

    /// Returns the brackets that a verdict states: those of one optimum must not exclude each other.
    pub fn intervals(&self, solution: &AnySolution, verdict: &AnyVerdict) -> Vec<Interval> {
        match (solution, verdict) {
            (AnySolution::Ball(found), AnyVerdict::Ball(verdict)) => {
                let optimum = format!("the least radius around {:?}", found.certificate.items);
                vec![Interval { optimum, lower: verdict.lower, upper: verdict.upper }]
            }
            (AnySolution::Centers(found), AnyVerdict::Centers(verdict)) => {
                let of = &found.certificate;
                let weights = if of.weights { " with weights" } else { "" };
                let optimum = format!(
                    "the least radius of {} balls, {:?}, around {:?}{weights} but {}",
                    of.k, of.placement, of.items, of.outliers
                );
                vec![Interval { optimum, lower: verdict.lower, upper: verdict.upper }]
            }
            (AnySolution::Circle(_), AnyVerdict::Circle(verdict)) => {
                let optimum = "the largest radius inside".to_owned();
                vec![Interval { optimum, lower: verdict.lower, upper: verdict.upper }]
            }
            (AnySolution::Convex(_), AnyVerdict::Convex(verdict)) => {
                let optimum = "the largest area of a convex set inside".to_owned();
                vec![Interval { optimum, lower: verdict.lower, upper: verdict.upper }]
            }
            (AnySolution::OrientedRectangle(_), AnyVerdict::OrientedRectangle(verdict)) => {
                let optimum = "the largest area of a rectangle of any direction inside".to_owned();
                vec![Interval { optimum, lower: verdict.lower, upper: verdict.upper }]
            }
            (AnySolution::Rectangle(_), AnyVerdict::Rectangle(verdict)) => {
                let optimum = "the largest area of a rectangle inside".to_owned();
                vec![Interval { optimum, lower: verdict.lower, upper: verdict.upper }]
            }
            (AnySolution::Ellipse(_), AnyVerdict::Ellipse(verdict)) => {
                let optimum = "the largest area inside".to_owned();
                vec![Interval { optimum, lower: verdict.lower, upper: verdict.upper }]
            }
            (AnySolution::Triangle(_), AnyVerdict::Triangle(verdict)) => {
                let optimum = "the largest area of a triangle inside".to_owned();
                vec![Interval { optimum, lower: verdict.lower, upper: verdict.upper }]
            }
            (AnySolution::Ellipsoid(found), AnyVerdict::Ellipsoid(verdict)) => {
                let (items, rank) = (found.certificate.items, verdict.rank);
                let optimum = format!("the least log-volume around {items:?} of rank {rank}");
                vec![Interval { optimum, lower: verdict.lower, upper: verdict.upper }]
            }
            (AnySolution::Inscribed(_), AnyVerdict::Inscribed(verdict)) => {
                let optimum = "the largest log-volume inside".to_owned();
                vec![Interval { optimum, lower: verdict.lower, upper: verdict.upper }]
            }
            (AnySolution::Robust(found), AnyVerdict::Robust(verdict)) => {
                let without = |enclosure: &taut::certify::Enclosure| {
                    format!("the least log-volume but for {:?}", enclosure.certificate.left_out)
                };
                let optimum = found.certificate.enclosure.as_ref().map(without);
                let of = |(optimum, verdict): (String, EllipsoidVerdict)| Interval {
                    optimum: format!("{optimum} of rank {}", verdict.rank),
                    lower: verdict.lower,
                    upper: verdict.upper,
                };
                optimum.zip(verdict.enclosure).map(of).into_iter().collect()
            }
            _ => vec![],
        }
    }
}

/// The verdict with an infinite gap, which claims nothing, replaced by the largest that is a number.
fn finite(verdict: &EllipsoidVerdict) -> EllipsoidVerdict {
    match verdict.gap {
        f64::INFINITY => EllipsoidVerdict { lower: -f64::MAX, gap: f64::MAX, ..*verdict },
        _ => *verdict,
    }
}
