//! Real places, full of ties and copies, where the folder `TAUT_DATA` holds them: borders of the counties of the USA on
//! a grid of integers, towns of the world by longitude and latitude, and two sets of TSPLIB.

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::PathBuf;

use liblzma::read::XzDecoder;

use crate::test_folder::TestFolder;

/// The file of this name; says that it is not there if so.
fn found(name: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("TAUT_DATA").map(PathBuf::from).unwrap_or_default();
    let file = folder.join("delaunay").join(name);
    let is_there = file.is_absolute() && file.exists();
    if !is_there {
        eprintln!("skipped: {name}, as TAUT_DATA does not hold it");
    }
    is_there.then_some(file)
}

/// Triangulates the points and judges the mesh that was written. `sites` is what the summary says of them.
fn is_verified(folder: &TestFolder, points: &str, sites: &str) {
    folder
        .taut(&format!("delaunay {points} -o mesh.ply"))
        .ends(0)
        .stdout_has(&[&format!("\n  sites       {sites}\n"), "\n  verified    yes; "]);
    let distinct = sites.split(';').next().unwrap();
    folder.taut(&format!("verify mesh.ply {points}")).ends(0).stdout_has(&[
        "Verified",
        &format!("\n  sites       {distinct}; proved: distinct points\n"),
    ]);
}

#[test]
fn county_borders_are_verified() {
    let Some(file) = found("us_counties_10m_points.csv.xz") else { return };
    let mut text = String::new();
    XzDecoder::new(BufReader::new(File::open(file).unwrap())).read_to_string(&mut text).unwrap();
    // Its first line is a remark, and no header of two columns.
    let (_, rows) = text.split_once('\n').unwrap();
    let folder = TestFolder::new();
    folder.put("counties.csv", rows);
    is_verified(&folder, "counties.csv", "33,416; 13,149 points equal an earlier one");
}

#[test]
fn towns_are_verified() {
    let Some(file) = found("geonames_cities1000.csv.xz") else { return };
    let sites = "135,182; 51 points equal an earlier one";
    is_verified(&TestFolder::new(), &format!("{} --columns lon,lat", file.display()), sites);
}

#[test]
fn places_of_tsplib_are_verified() {
    for (name, sites) in [("tsplib_d18512.tsp.xz", "18,512"), ("tsplib_usa13509.tsp.xz", "13,509")]
    {
        let Some(file) = found(name) else { continue };
        let points = file.display().to_string();
        is_verified(&TestFolder::new(), &points, &format!("{sites}; no two points are equal"));
    }
}
