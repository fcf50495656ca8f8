//! The stop at the memory hierarchy: misses that are counted, beside the formulas that bound them.

use taut_draw::{Field, Figure, Section};

use super::Stop;
use crate::commands::memory::panel;
use crate::output::numbers::short;

pub(super) const HEADING: &str = "Memory hierarchy";

/// Runs algorithms of the library under simulated memories; verified means that no count is above its bound.
pub(super) fn stop() -> anyhow::Result<Stop> {
    let panel = panel()?;
    let verified = panel.worst.iter().all(|(_, ratio, allowed)| ratio <= allowed);
    let fields = panel.worst.iter().map(|(name, ratio, allowed)| {
        let (ratio, allowed) = (short((ratio * 1e3).round() / 1e3), short(*allowed));
        Field::new(*name, format!("at most {ratio} times the formula, allowed {allowed}"))
    });
    let text = "Cache-oblivious algorithms move few blocks between any two levels of memory without knowing their sizes. Here they \
                run under simulated memories of M bytes in blocks of B bytes, and every miss is counted: a matrix product \
                takes n³/(B√M), a transposition 2n²/B, a sort (n/B)(1 + log_{M/B}(n/B)) misses, in words of 8 bytes, up to a \
                constant. The counts are exact and the same on every machine.";
    let section = Section {
        heading: HEADING.to_owned(),
        text: text.to_owned(),
        command:
            "taut memory simulate multiply -n 64 --memory-sizes 2K,8K,32K --block 64 --draw misses.html"
                .to_owned(),
        fields: fields.collect(),
        figures: panel.plots.into_iter().map(Figure::Plot).collect(),
    };
    let product = panel.worst.first().map_or(0.0, |worst| worst.1);
    let summary = format!("product {product:.2} · n³/(B√M) misses");
    Ok(Stop { section, summary, verified })
}
