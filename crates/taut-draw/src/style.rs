//! Colors by meaning, in a light and a dark theme.
//!
//! *Idea.* A mark names what it stands for ([`Tone`]), never a color; a renderer writes the tone as a class, and a
//! theme gives the class its color. The palette is built on that of Okabe and Ito, which people with the common
//! forms of color blindness can tell apart; marks of differing meaning also differ in shape, size or dash.

/// The way in which figures are colored in SVG and PNG. Write `Style { theme: Theme::Dark, ..Default::default() }`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Style {
    /// Dark ink on white, or light ink on near-black. Default [`Theme::Light`].
    pub theme: Theme,
}

/// The two sets of colors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Theme {
    /// For paper and bright screens.
    #[default]
    Light,
    /// For dark screens.
    Dark,
}

/// The role of a mark.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Tone {
    /// Input points, of which there are many.
    #[default]
    Point,
    /// The few points that decide the answer.
    Support,
    /// The answer.
    Answer,
    /// A proved lower bound.
    Bound,
    /// A second thing to compare with.
    Second,
    /// A third thing to compare with.
    Third,
    /// A fourth thing to compare with.
    Fourth,
    /// Text and centers.
    Ink,
    /// Axes and remarks.
    Muted,
}

/// The way in which lines and areas are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LineStyle {
    /// A line.
    #[default]
    Solid,
    /// A broken line.
    Dashed,
    /// A line around a translucent area.
    Filled,
    /// A thin line, for the many that make up a mesh.
    Thin,
}

impl Tone {
    /// All tones, in the order of the palette.
    pub const ALL: [Tone; 9] = [
        Tone::Point,
        Tone::Support,
        Tone::Answer,
        Tone::Bound,
        Tone::Second,
        Tone::Third,
        Tone::Fourth,
        Tone::Ink,
        Tone::Muted,
    ];

    /// The name, as it stands in classes and variables of the style sheet.
    pub const fn name(self) -> &'static str {
        match self {
            Tone::Point => "point",
            Tone::Support => "support",
            Tone::Answer => "answer",
            Tone::Bound => "bound",
            Tone::Second => "second",
            Tone::Third => "third",
            Tone::Fourth => "fourth",
            Tone::Ink => "ink",
            Tone::Muted => "muted",
        }
    }
}

/// Colors beside the tones: the ground, the grid.
const GROUND: [&str; 2] = ["#ffffff", "#14181d"];
const GRID: [&str; 2] = ["#e4e8ec", "#2b333b"];

impl Theme {
    fn pick(self, pair: [&'static str; 2]) -> &'static str {
        pair[usize::from(self == Theme::Dark)]
    }

    pub(crate) fn color(self, tone: Tone) -> &'static str {
        self.pick(match tone {
            Tone::Point => ["#52697c", "#9db2c4"],
            Tone::Support => ["#d55e00", "#ff8c42"],
            Tone::Answer => ["#0072b2", "#5db4ee"],
            Tone::Bound => ["#00856a", "#3fd0a3"],
            Tone::Second => ["#b87f00", "#f0b93a"],
            Tone::Third => ["#b4588a", "#e39ac4"],
            Tone::Fourth => ["#3d8fc4", "#8fd0f7"],
            Tone::Ink => ["#17212b", "#e9eef2"],
            Tone::Muted => ["#586673", "#9aa8b5"],
        })
    }

    /// The variables of the theme for a page: `--point:#52697c;…`.
    pub(crate) fn variables(self) -> String {
        let mut out = format!("--ground:{};--grid:{};", self.pick(GROUND), self.pick(GRID));
        for tone in Tone::ALL {
            out += &format!("--{}:{};", tone.name(), self.color(tone));
        }
        out
    }

    /// The classes with the colors of this theme, for a document that stands alone.
    pub(crate) fn classes(self) -> String {
        classes(|name| match name {
            "ground" => self.pick(GROUND).into(),
            "grid" => self.pick(GRID).into(),
            name => Tone::ALL
                .into_iter()
                .find(|tone| tone.name() == name)
                .map(|tone| self.color(tone).into())
                .unwrap_or_default(),
        })
    }
}

/// The classes every drawing uses; `color` says what stands for a name.
pub(crate) fn classes(color: impl Fn(&str) -> String) -> String {
    let mut out = format!(
        ".t-ground{{fill:{ground}}}.t-grid{{stroke:{grid};fill:none;stroke-width:1}}\
         .t-axis{{stroke:{muted};fill:none;stroke-width:1;stroke-opacity:.6}}\
         .t-halo{{stroke:{ground};stroke-width:1.4}}\
         .t-title{{fill:{ink};font-weight:600;font-size:17px}}.t-name{{fill:{ink};font-size:13px}}\
         .t-tick{{fill:{muted};font-size:12px}}.t-caption{{fill:{muted};font-size:12.5px}}\
         .t-legend{{fill:{ink};font-size:12.5px}}.t-level{{font-size:12px;font-weight:600;stroke:{ground};stroke-width:2.5;stroke-linejoin:round;paint-order:stroke}}\
         .t-back{{opacity:.3}}.t-front{{opacity:.6}}",
        ground = color("ground"),
        grid = color("grid"),
        muted = color("muted"),
        ink = color("ink"),
    );
    for tone in Tone::ALL {
        let (name, color) = (tone.name(), color(tone.name()));
        out += &format!(
            ".f-{name}{{fill:{color}}}.e-{name}{{stroke:{color}}}.s-{name}{{stroke:{color};fill:none}}"
        );
    }
    out
}
