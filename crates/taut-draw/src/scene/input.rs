//! The subject of an answer: its items, which of them are drawn, and the words for them.

use taut_certify::Items;
use taut_points::{PointSource, gather};

use super::{Group, LEFT_OUT_SCALE, Layer, Marks};
use crate::item_pass::{ItemPass, Measure, PassQuery, item_pass, noun};
use crate::marks::{dot_size, drawn_of, misfit, others_name};
use crate::number::{count, counted};
use crate::{DrawOptions, Error, LineStyle, Tone};

/// The items of an answer, read once.
pub(crate) struct Input<'a> {
    pub(crate) source: &'a dyn PointSource,
    pub(crate) options: &'a DrawOptions,
    pub(crate) items: Items,
    pub(crate) dim: usize,
    pub(crate) item_pass: ItemPass,
}

impl<'a> Input<'a> {
    pub(crate) fn read(
        measure: &dyn Measure,
        question: &PassQuery<'_>,
        source: &'a dyn PointSource,
        options: &'a DrawOptions,
    ) -> Result<Self, Error> {
        let item_pass = item_pass(measure, question, source)?;
        Ok(Input { source, options, items: question.items, dim: measure.dim(), item_pass })
    }

    /// "point", "ball" or "ellipsoid".
    pub(crate) fn thing(&self) -> &'static str {
        noun(self.items)
    }

    /// A word and how many items it stands for, as in legends.
    pub(crate) fn named(&self, word: &str, items: usize) -> String {
        format!("{word} ({})", counted(items as u64, self.thing()))
    }

    pub(crate) fn row(&self, id: u64) -> Result<Vec<f64>, Error> {
        Ok(gather(self.source, &[id])?)
    }

    /// The drawn items of which nothing else is said.
    pub(crate) fn others(&self, ids: Vec<u64>) -> Result<Layer<'static>, Error> {
        self.group(others_name(self.items), Tone::Point, "", ids)
    }

    /// Items that the answer leaves out.
    pub(crate) fn left_out(
        &self,
        name: String,
        label: &'static str,
        ids: Vec<u64>,
    ) -> Result<Layer<'static>, Error> {
        let mut layer = self.group(name, Tone::Third, label, ids)?;
        if let Marks::Items(group) = &mut layer.marks {
            group.scale = LEFT_OUT_SCALE;
        }
        Ok(layer)
    }

    pub(crate) fn group(
        &self,
        name: String,
        tone: Tone,
        label: &'static str,
        ids: Vec<u64>,
    ) -> Result<Layer<'static>, Error> {
        let group = Group {
            items: self.items,
            rows: gather(self.source, &ids)?,
            columns: self.source.dim(),
            size: dot_size(self.item_pass.ids.len()),
            scale: 1.0,
            label,
            ids,
        };
        Ok(Layer::new(name, tone, LineStyle::Filled, Marks::Items(group)))
    }

    /// Returns what is drawn of how many: `kept` names those that are drawn in any case.
    pub(crate) fn drawn(&self, kept: &str) -> String {
        let far = match self.item_pass.far {
            0 => String::new(),
            far => format!("{} more that reach far, ", count(far)),
        };
        let which = format!("{kept}{far}and an even sample of the others");
        let drawn = self.item_pass.ids.len() as u64;
        drawn_of(drawn, self.source.len(), self.thing(), &which)
    }

    /// That items reach outside the answer, where some do.
    pub(crate) fn misfit(&self, shape: &str) -> String {
        misfit(self.item_pass.outside, self.thing(), shape)
    }
}
