//! Membranes: triangles that span gaps in the samples, left out.
//!
//! *Problem.* Labels close every surface, over the boundary of a sheet with triangles that nothing was sampled from. They are long
//! beside the edges around them, but how long is too long depends on how even the samples are: of random ones every edge in
//! a thousand is four times as long as most, of a scan none twice.
//! *Idea.* The edges at a vertex and at its neighbors have a median and quartiles; a triangle is suspect whose longest edge exceeds
//! the median at one of its vertices by more than [`EDGE_SPREADS_MAX`] times the distance between the quartiles there. Suspects that hang
//! together by edges are left out if the border around them is at least [`RIM_EDGES_MIN`] edges long; smaller ones are gaps that chance leaves.
//! *Trap.* A multiple of the median alone serves either scans or random samples: the bunny wants at most 3.5, a random hemisphere at
//! least 5. From 2 to 3 quartile distances serve both.
//! *Guarantee.* What is left is a surface with boundary where the whole was one: a vertex at which fans would touch keeps the largest.
//! A function of the points and the triangles; O(n).

use rayon::prelude::*;

use super::border::{Face, Links, is_fan};
use super::spheres::{Point, dot, minus};

/// Times the distance between the quartiles of edges around a vertex that an edge may exceed their median by.
const EDGE_SPREADS_MAX: f64 = 2.5;
/// The least such distance, as a share of the median.
const LEAST_SPREAD: f64 = 0.4;

/// The border around the smallest membrane has this many edges.
const RIM_EDGES_MIN: u32 = 14;
/// Vertices of one task.
const TASK: usize = 1 << 10;

/// The triangles that are no membranes, whatever is left.
pub(super) fn without_membranes(faces: &[Face], points: &[Point]) -> Vec<Face> {
    let links = Links::of(faces, points.len());
    let limits: Vec<f64> = (0..points.len() as u32)
        .into_par_iter()
        .with_min_len(TASK)
        .map(|site| limit(site, &links, points))
        .collect();
    let is_suspect = |face: &Face| {
        let [a, b, c] = face.sites;
        let longest = length(points, a, b).max(length(points, b, c)).max(length(points, c, a));
        face.sites.iter().any(|&site| longest > limits[site as usize])
    };
    let suspect: Vec<bool> = faces.iter().map(is_suspect).collect();
    without_groups(faces, &suspect)
}

/// Triangles without those that would make their vertices none of a surface.
pub(super) fn without_all_small_fans(mut faces: Vec<Face>, sites: usize) -> Vec<Face> {
    while let Some(rest) = without_small_fans(&faces, sites) {
        faces = rest;
    }
    faces
}

fn length(points: &[Point], a: u32, b: u32) -> f64 {
    let off = minus(points[a as usize], points[b as usize]);
    dot(off, off).sqrt()
}

/// Returns how long an edge at a site may be.
fn limit(site: u32, links: &Links, points: &[Point]) -> f64 {
    let mut lengths = Vec::new();
    let mut add = |from: u32| {
        lengths.extend(links.at(from).iter().map(|side| length(points, from, side[0])));
    };
    add(site);
    links.at(site).iter().for_each(|side| add(side[0]));
    lengths.sort_unstable_by(f64::total_cmp);
    let Some(last) = lengths.len().checked_sub(1) else { return 0.0 };
    let [low, median, high] = [1, 2, 3].map(|quarter| lengths[last * quarter / 4]);
    median + EDGE_SPREADS_MAX * (high - low).max(LEAST_SPREAD * median)
}

/// The faces without the suspects that hang together around a long rim.
fn without_groups(faces: &[Face], suspect: &[bool]) -> Vec<Face> {
    // The sides of suspects, each next to itself seen from the other side.
    let mut sides: Vec<([u32; 2], u32)> = Vec::new();
    for (number, face) in (0u32..).zip(faces).filter(|(number, _)| suspect[*number as usize]) {
        let [a, b, c] = face.sites;
        sides.extend([[a, b], [b, c], [c, a]].map(|[p, q]| ([p.min(q), p.max(q)], number)));
    }
    sides.sort_unstable();
    let mut group: Vec<u32> = (0..faces.len() as u32).collect();
    let root = |group: &mut [u32], mut face: u32| {
        while group[face as usize] != face {
            group[face as usize] = group[group[face as usize] as usize];
            face = group[face as usize];
        }
        face
    };
    for pair in sides.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        let (a, b) = (root(&mut group, pair[0].1), root(&mut group, pair[1].1));
        group[a.max(b) as usize] = a.min(b);
    }
    let mut rim = vec![0u32; faces.len()];
    for same in sides.chunk_by(|one, other| one.0 == other.0) {
        if let [(_, face)] = same {
            rim[root(&mut group, *face) as usize] += 1;
        }
    }
    let group: Vec<u32> = (0..faces.len() as u32).map(|face| root(&mut group, face)).collect();
    let is_kept = |number: usize| !suspect[number] || rim[group[number] as usize] < RIM_EDGES_MIN;
    (0..faces.len()).filter(|&number| is_kept(number)).map(|number| faces[number]).collect()
}

/// The faces without all but the largest fan of each vertex that has several; none if no vertex has.
fn without_small_fans(faces: &[Face], sites: usize) -> Option<Vec<Face>> {
    let links = Links::of(faces, sites);
    let mut failing = links.failing(is_fan);
    failing.retain(|&site| !links.at(site).is_empty());
    let mut dropped: Vec<[u32; 3]> = Vec::new();
    for site in failing {
        let mut fans = fans(links.at(site));
        // The largest stays, of several the one with the smallest neighbor.
        fans.sort_by_key(|fan| (std::cmp::Reverse(fan.len()), fan.iter().copied().min()));
        for side in fans.into_iter().skip(1).flatten() {
            let mut name = [site, side[0], side[1]];
            name.sort_unstable();
            dropped.push(name);
        }
    }
    dropped.sort_unstable();
    let name = |face: &Face| {
        let mut sites = face.sites;
        sites.sort_unstable();
        sites
    };
    let is_kept = |face: &&Face| dropped.binary_search(&name(face)).is_err();
    (!dropped.is_empty()).then(|| faces.iter().filter(is_kept).copied().collect())
}

/// The sides of a link by the paths and cycles that they hang together in.
fn fans(link: &[[u32; 2]]) -> Vec<Vec<[u32; 2]>> {
    let mut fans: Vec<Vec<[u32; 2]>> = Vec::new();
    for &side in link {
        let meets = |fan: &Vec<[u32; 2]>| {
            fan.iter().any(|other| other.iter().any(|site| side.contains(site)))
        };
        let (met, mut rest): (Vec<_>, Vec<_>) = fans.into_iter().partition(meets);
        rest.push(met.into_iter().flatten().chain([side]).collect());
        fans = rest;
    }
    fans
}
