//! GeoJSON: positions as points of the plane, and the rings of polygons.
//!
//! *Read.* Point, MultiPoint, LineString, Polygon and MultiPolygon, alone, as a Feature or as the Features of a FeatureCollection.
//! Several Points are points in their order; of all other geometries there can be one. One ring has the columns x and y; where
//! there are more, a third column has the number of the ring, from 0, holes after the ring that they are in.
//! *Chosen.* One feature of several, by its number or by its property `name`.
//! *Refused.* Several geometries where none is chosen, with their places.
//! *Trap.* Positions are longitude and latitude in degrees. They are taken as points of the plane as they stand; a third number,
//! the height, is left out.
//! *Reference.* RFC 7946.

pub(super) mod json;

use std::io::BufRead;

use self::json::{Refusal, Value};
use super::Decoded;
use super::chains::{decode, held_text};
use crate::input::Job;
use crate::{Error, Feature, Format, limits};

pub(super) fn read(job: &Job<'_>, stream: Box<dyn BufRead>) -> Result<Decoded, Error> {
    // The text is held whole, and then its values: each may take half of the memory.
    let most = limits::most_held(job.options.memory) / 2;
    let too_large = |bytes| Error::TooLarge {
        path: job.path.to_owned(),
        problem: "a GeoJSON document",
        bytes,
        memory: most,
        remedy: "allow more memory, or write the positions as csv: x, y and the number of the ring",
    };
    let text = held_text(job, stream, most, too_large)?;
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
    let features = features(&document).map_err(damaged)?;
    let of_feature = |problem| Error::Feature { path: job.path.to_owned(), problem };
    let chosen = match &job.options.feature {
        None => {
            refuse_several(features).map_err(of_feature)?;
            0..features.len()
        }
        Some(wanted) => {
            let number = choose(features, wanted).map_err(of_feature)?;
            number..number + 1
        }
    };
    let chains = chains(&features[chosen.clone()], chosen.start).map_err(damaged)?;
    decode(job, chains.len() > 1, |put| {
        for (ring, positions) in chains.into_iter().enumerate() {
            positions.into_iter().try_for_each(|at| put(ring, at))?;
        }
        Ok(())
    })
}

/// The problem, as the end of a sentence about the file.
type Problem = String;

/// Positions that follow each other: points, a line or a ring.
type Chain = Vec<[f64; 2]>;

/// The features of the document, or the document itself where it is one.
fn features(document: &Value) -> Result<&[Value], Problem> {
    match kind(document, "the document")? {
        "FeatureCollection" => array(field(document, "features", "the document")?, "`features`"),
        _ => Ok(std::slice::from_ref(document)),
    }
}

/// The number of the feature that is wanted.
fn choose(features: &[Value], wanted: &Feature) -> Result<usize, Problem> {
    /// Names in a message, at most.
    const NAMES_SHOWN_MAX: usize = 8;
    let wanted = match wanted {
        Feature::Number(number) => {
            let found = usize::try_from(*number).ok().filter(|&number| number < features.len());
            let count = features.len();
            return found.ok_or_else(|| {
                format!("there is no feature {number}: it has {count}, counted from 0")
            });
        }
        Feature::Name(name) => name,
    };
    let named: Vec<usize> =
        (0..features.len()).filter(|&k| name(&features[k]) == Some(wanted.as_str())).collect();
    match named[..] {
        [number] => Ok(number),
        [one, other, ..] => Err(format!(
            "feature {one} and feature {other} (from 0) both have the name {wanted:?}: choose one by its number"
        )),
        [] => {
            let mut names: Vec<&str> = features.iter().filter_map(name).collect();
            let more = if names.len() > NAMES_SHOWN_MAX { ", …" } else { "" };
            names.truncate(NAMES_SHOWN_MAX);
            let known = match names[..] {
                [] => "no feature has a property `name`".to_owned(),
                _ => format!("there are {names:?}{more}"),
            };
            Err(format!("no feature has the name {wanted:?}; {known}"))
        }
    }
}

/// The property `name` of a feature, in either case.
fn name(feature: &Value) -> Option<&str> {
    let Value::Object(fields) = feature else { return None };
    let (_, properties) = fields.iter().find(|field| field.0 == "properties")?;
    let Value::Object(properties) = properties else { return None };
    properties.iter().find_map(|(key, value)| match value {
        Value::Text(name) if key.eq_ignore_ascii_case("name") => Some(name.as_str()),
        _ => None,
    })
}

/// Refuses features with several geometries, unless all are Points; what is wrong with a feature is said later.
fn refuse_several(features: &[Value]) -> Result<(), Problem> {
    let mut first: Option<(usize, bool)> = None;
    for (number, feature) in features.iter().enumerate() {
        let geometry = match field(feature, "geometry", "") {
            Ok(Value::Null) => continue,
            Ok(geometry) => geometry,
            Err(_) => feature,
        };
        let is_point = kind(geometry, "").is_ok_and(|kind| kind == "Point");
        match first {
            Some((other, all_points)) if !(all_points && is_point) => {
                return Err(format!(
                    "feature {other} and feature {number} (from 0) are both geometries, and one is read unless all are Points: \
                     choose one by its number or name with --select, as --select {other}, or write polygons that belong \
                     together as one MultiPolygon"
                ));
            }
            _ => first = first.or(Some((number, is_point))),
        }
    }
    Ok(())
}

/// The rings of features, or all their other positions as one chain; `before` features come before them.
fn chains(features: &[Value], before: usize) -> Result<Vec<Chain>, Problem> {
    let (mut found, mut points): (Vec<Chain>, Chain) = (vec![], vec![]);
    for (number, feature) in (before..).zip(features) {
        let place = format!("feature {number} (from 0)");
        let geometry = match kind(feature, &place)? {
            "Feature" => field(feature, "geometry", &place)?,
            _ => feature,
        };
        if matches!(geometry, Value::Null) {
            continue;
        }
        let is_point = kind(geometry, &place)? == "Point";
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
