//! Colours by meaning, in a light and a dark theme.
//!
//! *Idea.* A mark names what it stands for ([`Tone`]), never a colour; a renderer writes the tone as a class, and a
//! theme gives the class its colour. The palette is built on that of Okabe and Ito, which people with the common
//! forms of colour blindness can tell apart; marks of differing meaning also differ in shape, size or dash.

/// How figures are coloured in SVG and PNG. Write `Style { theme: Theme::Dark, ..Default::default() }`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Style {
    /// Dark ink on white, or light ink on near-black. Default [`Theme::Light`].
    pub theme: Theme,
}

/// The two sets of colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Theme {
    /// For paper and bright screens.
    #[default]
    Light,
    /// For dark screens.
    Dark,
}

/// What a mark stands for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Tone {
    /// Input points, of which there are many.
    #[default]
    Point,
    /// The few points that decide the answer.
    Support,
    /// The answer.
    Answer,
    /// What is proved: a lower bound.
    Bound,
    /// A second thing to compare with.
    Second,
    /// A third thing to compare with.
    Third,
    /// A fourth thing to compare with.
    Fourth,
    /// Text and centres.
    Ink,
    /// Axes and remarks.
    Muted,
}

/// How lines and areas are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Look {
    /// A line.
    #[default]
    Solid,
    /// A broken line.
    Dashed,
    /// A line around a translucent area.
    Filled,
}
