//! The kinds of answers, each stated once; what treats all of them alike is generated from these lists.
//!
//! To add a kind, implement [`Answer`] (or [`FileAnswer`]) and name it here. [`with_solution!`](crate::with_solution) runs
//! one expression on a solution of any kind, so that other crates need no list of their own.

use serde::Serialize;
use taut_points::{Monitor, PointSource};

use crate::json::{kind_of, parse_document, without_mark};
use crate::{
    Answer, Ball, BoundingDop, Centers, CheckError, ConvexPolygon, Curve, DrawnSample, Ellipsoid,
    FileAnswer, FileCheckError, FileSolution, FileVerdict, Files, InscribedBodies, InscribedCircle,
    InscribedEllipse, InscribedEllipsoid, InscribedOrientedRectangle, InscribedRectangle,
    InscribedTriangle, JsonError, KernelBall, Order, RobustEllipsoid, Solution, SortedFile,
    Surface, TransposedFile, Triangulation,
};

/// Hands the answers about points to a macro, each with the name of its variant.
macro_rules! answers_about_points {
    ($define:ident, $($more:tt)*) => {
        $define! {
            $($more)*
            /// A minimum enclosing ball.
            Ball(Ball),
            /// A minimum enclosing ball in the feature space of a kernel.
            KernelBall(KernelBall),
            /// A minimum volume enclosing ellipsoid.
            Ellipsoid(Ellipsoid),
            /// A maximum volume inscribed ellipsoid.
            Inscribed(InscribedEllipsoid),
            /// A robust ellipsoid.
            Robust(RobustEllipsoid),
            /// A largest circle in a polygon.
            Circle(InscribedCircle),
            /// A largest ellipse in a polygon.
            Ellipse(InscribedEllipse),
            /// A large convex polygon in a polygon.
            Convex(ConvexPolygon),
            /// A largest rectangle of any direction in a polygon.
            OrientedRectangle(InscribedOrientedRectangle),
            /// A largest rectangle along the axes in a polygon.
            Rectangle(InscribedRectangle),
            /// A largest triangle in a polygon.
            Triangle(InscribedTriangle),
            /// Convex bodies in a triangle mesh.
            Bodies(InscribedBodies),
            /// A bounding k-dop.
            Dop(BoundingDop),
            /// k centers.
            Centers(Centers),
            /// Curves of the plane.
            Curve(Curve),
            /// A surface through points of space.
            Surface(Surface),
            /// Points in the order of a curve.
            Order(Order),
            /// A Delaunay triangulation.
            Triangulation(Triangulation),
        }
    };
}

/// Hands the answers about files to a macro.
macro_rules! answers_about_files {
    ($define:ident, $($more:tt)*) => {
        $define! {
            $($more)*
            /// A file of records in order.
            Sort(SortedFile),
            /// A matrix turned.
            Transpose(TransposedFile),
            /// Numbers drawn.
            Sample(DrawnSample),
        }
    };
}

/// An enum of solutions of several kinds, with what JSON needs, and a macro that matches on it.
macro_rules! define_solutions {
    (
        ($dollar:tt) $(#[$doc:meta])* $any:ident of $solution:ident, matched by $with:ident;
        $($(#[$kind:meta])* $name:ident($answer:ty),)*
    ) => {
        $(#[$doc])*
        #[derive(Clone, Debug, PartialEq)]
        #[non_exhaustive]
        #[allow(clippy::large_enum_variant)] // one at a time, and most of it is on the heap
        pub enum $any {
            $($(#[$kind])* $name($solution<$answer>),)*
        }

        /// Evaluates an expression for a solution of any kind: the expression is compiled once for each kind, with the
        /// solution under the name given.
        #[macro_export]
        macro_rules! $with {
            ($dollar any:expr, $dollar found:pat => $dollar body:expr) => {
                match $dollar any {
                    $($crate::$any::$name($dollar found) => $dollar body,)*
                    #[allow(unreachable_patterns)] // outside this crate the enum can grow
                    _ => unreachable!("every kind is listed"),
                }
            };
        }

        impl $any {
            /// Reads a document, whatever its kind.
            ///
            /// # Errors
            /// [`JsonError`]; [`JsonError::Kind`] for kinds that are none of these.
            pub fn from_json(text: &str) -> Result<Self, JsonError> {
                let text = without_mark(text);
                Self::of_kind(&kind_of(text)?, text)
            }

            /// Reads a document of a kind that is known to be stated.
            fn of_kind(kind: &str, text: &str) -> Result<Self, JsonError> {
                $(
                    if kind == <$answer>::KIND {
                        let (answer, certificate, trace) = parse_document(text)?;
                        return Ok($any::$name($solution { answer, certificate, trace }));
                    }
                )*
                Err(JsonError::Kind { found: kind.to_owned() })
            }

            /// The document, as the solution itself writes it.
            pub fn to_json(&self) -> String {
                $with!(self, found => found.to_json())
            }

            /// The word for the kind in JSON: `"ball"`.
            pub fn kind(&self) -> &'static str {
                match self { $($any::$name(_) => <$answer>::KIND,)* }
            }
        }

        $(
            impl From<$solution<$answer>> for $any {
                fn from(found: $solution<$answer>) -> Self {
                    $any::$name(found)
                }
            }
        )*
    };
}

/// The verdicts of the same kinds, and the check that returns one.
macro_rules! define_verdicts {
    ($($(#[$kind:meta])* $name:ident($answer:ty),)*) => {
        /// The proved facts about an answer of any kind; serde sees the verdict alone.
        #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
        #[serde(untagged)]
        #[non_exhaustive]
        pub enum AnyVerdict {
            $($(#[$kind])* $name(<$answer as Answer>::Verdict),)*
        }

        impl AnySolution {
            /// Judges the answer over `source`, whatever its kind.
            ///
            /// # Errors
            /// As [`Solution::check`].
            pub fn check(
                &self,
                source: &dyn PointSource,
                monitor: &Monitor<'_>,
            ) -> Result<AnyVerdict, CheckError> {
                match self {
                    $(
                        AnySolution::$name(found) => found
                            .answer
                            .check(&found.certificate, source, monitor)
                            .map(AnyVerdict::$name),
                    )*
                }
            }
        }
    };
}

answers_about_points! {
    define_solutions,
    ($) /// A solution about points, of any kind, as read from a file.
    AnySolution of Solution, matched by with_solution;
}

answers_about_points! { define_verdicts, }

answers_about_files! {
    define_solutions,
    ($) /// A solution about a file, of any kind, as read from its JSON.
    AnyFileSolution of FileSolution, matched by with_file_solution;
}

impl AnyFileSolution {
    /// Judges the file that was written, whatever the kind.
    ///
    /// # Errors
    /// As [`FileAnswer::check`].
    pub fn check(
        &self,
        files: Files<'_>,
        monitor: &Monitor<'_>,
    ) -> Result<FileVerdict, FileCheckError> {
        with_file_solution!(self, found => found.check(files, monitor))
    }
}

/// An answer of any kind, about points or about files.
#[derive(Clone, Debug, PartialEq)]
pub enum AnyDocument {
    /// About points.
    Points(Box<AnySolution>),
    /// About files.
    Files(AnyFileSolution),
}

impl AnyDocument {
    /// Reads a document.
    ///
    /// # Errors
    /// [`JsonError`].
    pub fn from_json(text: &str) -> Result<Self, JsonError> {
        let text = without_mark(text);
        let kind = kind_of(text)?;
        match AnyFileSolution::of_kind(&kind, text) {
            Err(JsonError::Kind { .. }) => {
                let found = AnySolution::of_kind(&kind, text)?;
                Ok(AnyDocument::Points(Box::new(found)))
            }
            other => other.map(AnyDocument::Files),
        }
    }
}
