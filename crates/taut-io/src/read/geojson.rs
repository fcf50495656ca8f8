//! GeoJSON: positions as points of the plane, and the outer ring of one polygon.
//!
//! *Read.* Point, MultiPoint, LineString and Polygon, alone, as a Feature or as the Features of a FeatureCollection; a
//! MultiPolygon of one polygon. Several Points are points in their order; of all other geometries there can be one.
//! *Refused.* Polygons with holes and several geometries, each with its place: they need more than a list of points.
//! *Trap.* Positions are longitude and latitude in degrees. They are taken as points of the plane as they stand; a third number,
//! the height, is left out.
//! *Reference.* RFC 7946.

mod json;

use std::io::{BufRead, Read};

use self::json::Value;
use super::Decoded;
use crate::input::Job;
use crate::sink::Sink;
use crate::{Error, Format};

pub(super) fn read(job: &Job<'_>, mut stream: Box<dyn BufRead>) -> Result<Decoded, Error> {
    let mut text = vec![];
    stream.read_to_end(&mut text).map_err(|source| Error::reading(job.path, source))?;
    let damaged = |problem| Error::Damaged {
        path: job.path.to_owned(),
        format: Format::GeoJson,
        place: crate::FilePlace::File,
        problem,
    };
    let document = json::parse(&text).map_err(damaged)?;
    drop(text);
    let positions = document_positions(&document).map_err(damaged)?;
    let names = ["x", "y"].map(str::to_owned);
    let numbers = match &job.options.columns {
        Some(columns) => columns.resolve(job.path, &names, 2)?,
        None => vec![0, 1],
    };
    let mut sink = Sink::new(job, numbers.len());
    let mut row = Vec::with_capacity(numbers.len());
    for position in positions {
        row.clear();
        row.extend(numbers.iter().map(|&number| position[number]));
        sink.push(&row)?;
    }
    let columns = numbers.iter().map(|&number| names[number].clone()).collect();
    Ok(Decoded { source: sink.finish()?, columns, numbers: Some(numbers) })
}

/// The problem, as the end of a sentence about the file.
type Problem = String;

fn document_positions(document: &Value) -> Result<Vec<[f64; 2]>, Problem> {
    let features = match kind(document, "the document")? {
        "FeatureCollection" => array(field(document, "features", "the document")?, "`features`")?,
        _ => std::slice::from_ref(document),
    };
    let mut found: Vec<[f64; 2]> = vec![];
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
        found.extend(geometry_positions(geometry, &place)?);
    }
    Ok(found)
}

fn geometry_positions(geometry: &Value, place: &str) -> Result<Vec<[f64; 2]>, Problem> {
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
        list.iter().enumerate().map(|(number, value)| position(value, number)).collect()
    };
    let ring = |rings: &[Value]| match rings {
        [] => Ok(vec![]),
        [ring] => chain(array(ring, &format!("the ring of the {kind} of {place}"))?),
        [_, holes @ ..] => Err(format!(
            "the {kind} of {place} has {} beside its outer ring, and polygons with holes are not supported: remove the rings \
             from number 1 (from 0)",
            if holes.len() == 1 { "a hole".to_owned() } else { format!("{} holes", holes.len()) }
        )),
    };
    match kind {
        "Point" => Ok(vec![position(field(geometry, "coordinates", place)?, 0)?]),
        "MultiPoint" | "LineString" => chain(coordinates()?),
        "Polygon" => ring(coordinates()?),
        "MultiPolygon" => match coordinates()? {
            [] => Ok(vec![]),
            [polygon] => ring(array(polygon, &format!("the polygon of {place}"))?),
            several => Err(format!(
                "the MultiPolygon of {place} has {} polygons, and one is read: keep one of them",
                several.len()
            )),
        },
        other => Err(format!(
            "{place} is a {other:?}: expected a Point, MultiPoint, LineString, Polygon or MultiPolygon"
        )),
    }
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
