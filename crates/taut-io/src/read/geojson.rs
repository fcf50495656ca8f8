//! GeoJSON: positions as points of the plane, and the rings of polygons.
//!
//! *Read.* Point, MultiPoint, LineString, Polygon and MultiPolygon, alone, as a Feature or as the Features of a FeatureCollection.
//! Several Points are points in their order; of all other geometries there can be one. One ring has the columns x and y; where
//! there are more, a third column has the number of the ring, from 0, holes after the ring that they are in.
//! *Refused.* Several geometries, with their places.
//! *Trap.* Positions are longitude and latitude in degrees. They are taken as points of the plane as they stand; a third number,
//! the height, is left out.
//! *Reference.* RFC 7946.

mod json;

use std::io::{BufRead, Read};

use self::json::{Refusal, Value};
use super::Decoded;
use crate::input::Job;
use crate::sink::Sink;
use crate::{Error, Format, limits};

pub(super) fn read(job: &Job<'_>, mut stream: Box<dyn BufRead>) -> Result<Decoded, Error> {
    // The text is held whole, and then its values: each may take half of the memory.
    let most = limits::most_held(job.options.memory) / 2;
    let too_large = |bytes| Error::TooLarge {
        path: job.path.to_owned(),
        problem: "a GeoJSON document",
        bytes,
        memory: most,
        remedy: "allow more memory, or write the positions as csv: x, y and the number of the ring",
    };
    let mut text = vec![];
    stream
        .by_ref()
        .take(most.saturating_add(1))
        .read_to_end(&mut text)
        .map_err(|source| Error::reading(job.path, source))?;
    if text.len() as u64 > most {
        return Err(too_large(text.len() as u64));
    }
    let damaged = |problem| Error::Damaged {
        path: job.path.to_owned(),
        format: Format::GeoJson,
        place: crate::FilePlace::File,
        problem,
    };
    let document = json::parse(&text, most).map_err(|refusal| match refusal {
        Refusal::NotJson(problem) => damaged(problem),
        Refusal::TooLarge(bytes) => too_large(bytes),
    })?;
    drop(text);
    let chains = document_chains(&document).map_err(damaged)?;
    let width = if chains.len() > 1 { 3 } else { 2 };
    let names = ["x", "y", "ring"].map(str::to_owned);
    let numbers = match &job.options.columns {
        Some(columns) => columns.resolve(job.path, &names[..width], width)?,
        None => (0..width).collect(),
    };
    let mut sink = Sink::new(job, numbers.len());
    let mut row = Vec::with_capacity(numbers.len());
    for (ring, positions) in chains.into_iter().enumerate() {
        for [x, y] in positions {
            let all = [x, y, ring as f64];
            row.clear();
            row.extend(numbers.iter().map(|&number| all[number]));
            sink.push(&row)?;
        }
    }
    let columns = numbers.iter().map(|&number| names[number].clone()).collect();
    Ok(Decoded { source: sink.finish()?, columns, numbers: Some(numbers) })
}

/// The problem, as the end of a sentence about the file.
type Problem = String;

/// Positions that follow each other: points, a line or a ring.
type Chain = Vec<[f64; 2]>;

/// The rings of the document, or all its other positions as one chain.
fn document_chains(document: &Value) -> Result<Vec<Chain>, Problem> {
    let features = match kind(document, "the document")? {
        "FeatureCollection" => array(field(document, "features", "the document")?, "`features`")?,
        _ => std::slice::from_ref(document),
    };
    let (mut found, mut points): (Vec<Chain>, Chain) = (vec![], vec![]);
    let mut first: Option<(usize, bool)> = None;
    for (number, feature) in features.iter().enumerate() {
        let place = format!("feature {number} (from 0)");
        let geometry = match kind(feature, &place)? {
            "Feature" => field(feature, "geometry", &place)?,
            _ => feature,
        };
        if matches!(geometry, Value::Null) {
            continue;
        }
        let is_point = kind(geometry, &place)? == "Point";
        match first {
            Some((other, all_points)) if !(all_points && is_point) => {
                return Err(format!(
                    "feature {other} and feature {number} (from 0) are both geometries, and one is read unless all are Points: \
                     keep one of them"
                ));
            }
            _ => first = first.or(Some((number, is_point))),
        }
        let chains = geometry_chains(geometry, &place)?;
        match is_point {
            true => points.extend(chains.concat()),
            false => found = chains,
        }
    }
    if !points.is_empty() {
        found.push(points);
    }
    Ok(found)
}

/// The rings of a geometry, or its other positions as one chain.
fn geometry_chains(geometry: &Value, place: &str) -> Result<Vec<Chain>, Problem> {
    let kind = kind(geometry, place)?;
    let coordinates = || {
        let place = format!("the {kind} of {place}");
        array(field(geometry, "coordinates", &place)?, &format!("`coordinates` of {place}"))
    };
    let position = |value: &Value, number: usize| {
        position(value).ok_or_else(|| {
            format!(
                "position {number} (from 0) of the {kind} of {place} is not a list of at least 2 finite numbers"
            )
        })
    };
    let chain = |list: &[Value]| {
        list.iter()
            .enumerate()
            .map(|(number, value)| position(value, number))
            .collect::<Result<Chain, _>>()
    };
    let rings = |list: &[Value], found: &mut Vec<Chain>| {
        for (number, ring) in list.iter().enumerate() {
            let place = format!("ring {number} (from 0) of the {kind} of {place}");
            found.push(chain(array(ring, &place)?)?);
        }
        Ok::<(), Problem>(())
    };
    let mut found = vec![];
    match kind {
        "Point" => found.push(vec![position(field(geometry, "coordinates", place)?, 0)?]),
        "MultiPoint" | "LineString" => found.push(chain(coordinates()?)?),
        "Polygon" => rings(coordinates()?, &mut found)?,
        "MultiPolygon" => {
            for (number, polygon) in coordinates()?.iter().enumerate() {
                let place = format!("polygon {number} (from 0) of the MultiPolygon of {place}");
                rings(array(polygon, &place)?, &mut found)?;
            }
        }
        other => {
            return Err(format!(
                "{place} is a {other:?}: expected a Point, MultiPoint, LineString, Polygon or MultiPolygon"
            ));
        }
    }
    Ok(found)
}

/// The first two numbers of a position.
fn position(value: &Value) -> Option<[f64; 2]> {
    let Value::Array(numbers) = value else { return None };
    let [Value::Number(x), Value::Number(y), ..] = numbers[..] else { return None };
    (x.is_finite() && y.is_finite()).then_some([x, y])
}

/// The `type` of an object.
fn kind<'a>(value: &'a Value, place: &str) -> Result<&'a str, Problem> {
    match field(value, "type", place)? {
        Value::Text(kind) => Ok(kind),
        _ => Err(format!("the `type` of {place} is no text")),
    }
}

fn field<'a>(value: &'a Value, name: &str, place: &str) -> Result<&'a Value, Problem> {
    let Value::Object(fields) = value else { return Err(format!("{place} is no object")) };
    let found = fields.iter().find(|field| field.0 == name);
    found.map(|field| &field.1).ok_or_else(|| format!("{place} has no `{name}`"))
}

fn array<'a>(value: &'a Value, place: &str) -> Result<&'a [Value], Problem> {
    match value {
        Value::Array(items) => Ok(items),
        _ => Err(format!("{place} is no list")),
    }
}
