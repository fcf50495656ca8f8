//! Meshes that an answer is written as.

use std::path::Path;

use anyhow::bail;
use taut_io::{Content, Format};

use crate::output::picture::Picture;

/// The format of the mesh that goes to `out`; none where JSON does.
pub(crate) fn mesh_format(out: Option<&Path>) -> anyhow::Result<Option<Format>> {
    let Some(out) = out else { return Ok(None) };
    let json = out.extension().is_none_or(|extension| extension.eq_ignore_ascii_case("json"));
    let shown = out.display();
    match Format::of_path_for(out, Content::Surface) {
        Some(format) if format.writes(Content::Surface) => Ok(Some(format)),
        None if json => Ok(None),
        None if Picture::of_path(out).is_ok() => {
            bail!("{shown}: -o writes JSON or the mesh; draw with --draw {shown}")
        }
        _ => {
            let formats = Format::all().filter(|format| format.writes(Content::Surface));
            let names: Vec<String> =
                formats.map(|format| format!(".{}", format.extensions()[0])).collect();
            bail!("{shown}: -o writes .json, {}; name one of these", names.join(", "))
        }
    }
}
