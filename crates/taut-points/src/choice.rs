//! Options that are one of a few names: on the command line, in Python, in traces and in JSON.

/// A type whose values have names. [`choice!`](crate::choice!) implements it.
pub trait Choice: Copy + Send + Sync + 'static {
    /// Each name, its value and what it means in a few words, the default first.
    const CHOICES: &'static [(&'static str, Self, &'static str)];
}

/// Names the values of an enum once: implements `ALL`, `name`, [`Display`](std::fmt::Display),
/// [`FromStr`](std::str::FromStr) and [`Choice`].
///
/// A variant with data is listed with the data it has by default.
///
/// ```
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// enum Direction {
///     Up,
///     Along(u32),
/// }
/// taut_points::choice! { "direction", Direction {
///     Up = "up", "against gravity";
///     Along(1) = "along", "along an axis";
/// }}
///
/// assert_eq!("along".parse::<Direction>()?, Direction::Along(1));
/// assert_eq!(Direction::Along(2).name(), "along");
/// let refused = "down".parse::<Direction>().unwrap_err();
/// assert_eq!(refused.to_string(), "option `direction` is down: expected up or along");
/// # Ok::<(), taut_points::InputError>(())
/// ```
#[macro_export]
macro_rules! choice {
    ($option:literal, $type:ident {
        $($variant:ident $(($default:expr))? = $name:literal, $help:literal;)+
    }) => {
        impl $type {
            /// All of them, the default first.
            pub const ALL: [Self; [$($name),+].len()] = [$(Self::$variant $(($default))?),+];

            /// The name on the command line, in Python, in traces and in JSON.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant { .. } => $name,)+
                }
            }
        }

        impl ::std::fmt::Display for $type {
            fn fmt(&self, f: &mut ::std::fmt::Formatter<'_>) -> ::std::fmt::Result {
                f.write_str(self.name())
            }
        }

        impl ::std::str::FromStr for $type {
            type Err = $crate::InputError;

            fn from_str(name: &str) -> Result<Self, $crate::InputError> {
                Self::ALL.into_iter().find(|value| value.name() == name).ok_or_else(|| {
                    $crate::InputError::Option {
                        name: $option,
                        value: name.to_owned(),
                        expected: $crate::choice!(@list $($name),+),
                    }
                })
            }
        }

        impl $crate::Choice for $type {
            const CHOICES: &'static [(&'static str, Self, &'static str)] =
                &[$(($name, Self::$variant $(($default))?, $help)),+];
        }
    };
    (@list $only:literal) => { $only };
    (@list $first:literal, $last:literal) => { concat!($first, " or ", $last) };
    (@list $first:literal, $($rest:literal),+) => {
        concat!($first, ", ", $crate::choice!(@list $($rest),+))
    };
}
