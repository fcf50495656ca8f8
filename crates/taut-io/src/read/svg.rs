//! SVG: the subpaths of one path as rings, curves as chords.
//!
//! *Read.* The `d` of a `<path>`: of the only one that is drawn, or of the one chosen by number or `id`. Paths within `<defs>`,
//! `<clipPath>`, `<marker>`, `<mask>`, `<pattern>` and `<symbol>` are not drawn by themselves and do not count. Each subpath is a
//! ring. The numbers of the path are the coordinates, so that y points down as in SVG.
//! *Curves* become chords no farther from the curve than 1e-4 of its size: see [`path`]. To refuse curves instead would refuse
//! nearly all drawings; what is found in the polygon is proved of the polygon of chords.
//! *Refused.* Several paths, by number; a `transform` of the path or around it, by line, as it would change the shape: it is to be
//! applied first. `scale(1 -1)` alone, which taut itself writes, turns the picture over and is passed over.
//! *Why our own.* Of XML little is needed here. Crates that parse path data report no line, and flatten arcs through cubic
//! curves with an error of their own.
//! *Reference.* SVG 2, chapter 9; XML 1.0.

mod curves;
mod path;
mod tags;

use std::io::BufRead;

use self::tags::{Tag, Tags};
use super::Decoded;
use super::chains::{Stop, read_text};
use crate::input::Job;
use crate::{Error, Feature};

/// Elements whose paths are not drawn by themselves.
const UNDRAWN_ELEMENTS: [&[u8]; 6] =
    [b"defs", b"clipPath", b"marker", b"mask", b"pattern", b"symbol"];

pub(super) fn read(job: &Job<'_>, stream: Box<dyn BufRead>) -> Result<Decoded, Error> {
    let wanted = job.options.feature.as_ref();
    read_text(job, stream, "an SVG document", |text, put| {
        let chosen = choose(job.path, text, wanted)?;
        if let Some(at) = chosen.transform {
            let problem = "the path is under a `transform`, which would change its shape: apply it to the coordinates first";
            return Err(Stop::Text(at, problem.to_owned()));
        }
        path::walk(text, chosen.data, put)
    })
}

/// The path that is read.
struct Chosen {
    number: u64,
    /// Where its data stand in the text.
    data: std::ops::Range<usize>,
    /// Where the first `transform` that it is under begins.
    transform: Option<usize>,
}

fn choose(file: &str, text: &[u8], wanted: Option<&Feature>) -> Result<Chosen, Stop> {
    let failed = |problem| Stop::Failed(Error::Feature { path: file.to_owned(), problem });
    let mut tags = Tags::new(text);
    // For each element that is open: whether its paths are drawn, and the transform that they are under.
    let mut open: Vec<(bool, Option<usize>)> = vec![];
    let mut chosen: Option<Chosen> = None;
    let mut count = 0;
    while let Some(tag) = tags.next()? {
        let (name, attributes, is_whole) = match tag {
            Tag::Start { name, attributes, is_whole } => (name, attributes, is_whole),
            Tag::End { at } => {
                if open.pop().is_none() {
                    return Err(Stop::Text(
                        at,
                        "the end of an element that is not open".to_owned(),
                    ));
                }
                continue;
            }
        };
        let (is_drawn, around) = open.last().copied().unwrap_or((true, None));
        let is_drawn = is_drawn && !UNDRAWN_ELEMENTS.contains(&name);
        let (mut transform, mut data, mut id) = (around, None, None);
        for attribute in attributes {
            let value = &text[attribute.value.clone()];
            match attribute.name {
                b"transform" if !turns_over(value) => {
                    transform = transform.or(Some(attribute.value.start));
                }
                b"d" => data = Some(attribute.value),
                b"id" => id = Some(value),
                _ => {}
            }
        }
        if !is_whole {
            open.push((is_drawn, transform));
        }
        let Some(data) = data.filter(|_| name == b"path" && is_drawn) else { continue };
        let number = count;
        count += 1;
        let is_wanted = match wanted {
            None => true,
            Some(Feature::Number(wanted)) => *wanted == number,
            Some(Feature::Name(wanted)) => id == Some(wanted.as_bytes()),
        };
        match chosen {
            _ if !is_wanted => {}
            Some(Chosen { number: other, .. }) => {
                return Err(failed(format!(
                    "path {other} and path {number} (from 0) are both there, and one is read: choose one by its number or `id` \
                     with --select"
                )));
            }
            None => chosen = Some(Chosen { number, data, transform }),
        }
    }
    chosen.ok_or_else(|| match wanted {
        None => failed("there is no path in it: only the `d` of a <path> is read".to_owned()),
        Some(Feature::Number(number)) => {
            failed(format!("there is no path {number}: it has {count}, counted from 0"))
        }
        Some(Feature::Name(name)) => failed(format!("no path has the `id` {name:?}")),
    })
}

/// Whether a transform is `scale(1 -1)`.
fn turns_over(transform: &[u8]) -> bool {
    let text = String::from_utf8_lossy(transform).replace(',', " ");
    text.split_whitespace().collect::<Vec<_>>().join(" ") == "scale(1 -1)"
}
