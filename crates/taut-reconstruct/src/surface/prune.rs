//! Membranes: triangles that span gaps in the samples, left out.
//!
//! *Problem.* Labels close every surface, over the boundary of a sheet with triangles that nothing was sampled from. Their circumcircles
//! are large, but how large is too large depends on how even the samples are.
//! *Idea.* Of independent random points, one per s², the circumcircle of a Delaunay triangle has a radius beyond r with the probability
//! (1 + u)·exp(−u), u = πr²/s². So a radius that even 2n triangles reach only once in a hundred samples is a gap: 2.4 s for
//! 20 000 points. Such triangles, and all suspects around them with radii that one in a thousand reaches, are left out if the border
//! around them is at least [`RIM_EDGES_MIN`] edges long. All other samplings have smaller circles: along scan lines eight times as far
//! apart as the points on them, 1.4 s.
//! *Trap.* Limits to the lengths of edges, as multiples of their median or of the distance between their quartiles, miss holes of a radius
//! of 4 s in random samples, or tear sheets that were sampled along lines.
//! *Guarantee.* What is left is a surface with boundary where the whole was one: a vertex at which fans would touch keeps the largest.
//! A function of the points and the triangles; O(n).
//! *Reference.* R. E. Miles, *On the homogeneous planar Poisson point process*, Math. Biosci. 6, 1970, for the distribution of the radius.

use std::f64::consts::PI;

use taut_points::OrderBy;
use taut_points::parallel::IntoParallel;

use super::border::{Face, Links, is_fan};
use super::spheres::{Point, circumcircle, cross, dot, minus};

/// The number of triangles of a random sample that are taken for gaps.
const CHANCE_GAPS: f64 = 0.01;
/// The share of triangles of a random sample that are suspect.
const CHANCE_SUSPECTS: f64 = 1e-3;
/// The median area of triangles of random points is this share of s².
const MEDIAN_AREA_SHARE: f64 = 0.38;

/// The border around the smallest membrane has this many edges.
const RIM_EDGES_MIN: u32 = 8;
/// Vertices of one task.
const TASK: usize = 1 << 10;

/// The triangles that are no membranes, whatever is left.
pub(super) fn without_membranes(faces: &[Face], points: &[Point]) -> Vec<Face> {
    let links = Links::of(faces, points.len());
    let [gap, suspect] = [CHANCE_GAPS / faces.len().max(1) as f64, CHANCE_SUSPECTS].map(radius_of);
    let areas: Vec<f64> = faces.iter().map(|face| area(face, points)).collect();
    let faces_at = FacesAt::of(faces, points.len());
    let spacings: Vec<f64> = (0..points.len() as u32)
        .into_par_iter()
        .with_min_len(TASK)
        .map(|site| spacing(site, &links, &faces_at, &areas))
        .collect();
    let radius = |face: &Face| {
        let [a, b, c] = face.sites.map(|site| points[site as usize]);
        let usual = face.sites.map(|site| spacings[site as usize]).into_iter().fold(0.0, f64::max);
        circumcircle(a, b, c).radius / usual
    };
    let radii: Vec<f64> = faces.iter().map(radius).collect();
    let suspects: Vec<bool> = radii.iter().map(|&radius| radius > suspect).collect();
    let gaps: Vec<bool> = radii.iter().map(|&radius| radius > gap).collect();
    without_groups(faces, &suspects, &gaps)
}

/// The radius, over s, that so large a share of the circumcircles of a random sample exceeds.
fn radius_of(share: f64) -> f64 {
    let exceeding = |u: f64| (1.0 + u) * (-u).exp();
    let (mut low, mut high) = (0.0, 100.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if exceeding(middle) > share { low = middle } else { high = middle }
    }
    (high / PI).sqrt()
}

fn area(face: &Face, points: &[Point]) -> f64 {
    let [a, b, c] = face.sites.map(|site| points[site as usize]);
    let normal = cross(minus(b, a), minus(c, a));
    0.5 * dot(normal, normal).sqrt()
}

/// The faces at each site.
struct FacesAt {
    begins: Vec<u32>,
    faces: Vec<u32>,
}

impl FacesAt {
    fn of(faces: &[Face], sites: usize) -> Self {
        let mut begins = vec![0u32; sites + 2];
        let corners = || (0u32..).zip(faces).flat_map(|(k, face)| face.sites.map(|site| (site, k)));
        corners().for_each(|(site, _)| begins[site as usize + 2] += 1);
        for site in 2..begins.len() {
            begins[site] += begins[site - 1];
        }
        let mut all = vec![0; 3 * faces.len()];
        for (site, face) in corners() {
            let place = &mut begins[site as usize + 1];
            all[*place as usize] = face;
            *place += 1;
        }
        Self { begins, faces: all }
    }

    fn at(&self, site: u32) -> &[u32] {
        &self.faces[self.begins[site as usize] as usize..self.begins[site as usize + 1] as usize]
    }
}

/// Returns the distance s for which there is one sample per s² around a site, from the areas of the triangles of it and its neighbors.
fn spacing(site: u32, links: &Links, faces_at: &FacesAt, areas: &[f64]) -> f64 {
    let around = links.at(site).iter().map(|side| side[0]).chain([site]);
    let mut faces: Vec<u32> = around.flat_map(|other| faces_at.at(other)).copied().collect();
    faces.sort_unstable();
    faces.dedup();
    let mut areas: Vec<f64> = faces.iter().map(|&face| areas[face as usize]).collect();
    let Some(last) = areas.len().checked_sub(1) else { return 0.0 };
    let median = *areas.select_nth_unstable_by(last / 2, f64::total_cmp).1;
    (median / MEDIAN_AREA_SHARE).sqrt()
}

/// Triangles without those that would make their vertices none of a surface.
pub(super) fn without_all_small_fans(mut faces: Vec<Face>, sites: usize) -> Vec<Face> {
    while let Some(rest) = without_small_fans(&faces, sites) {
        faces = rest;
    }
    faces
}

/// The faces without the suspects that hang together around a long rim and hold a gap.
fn without_groups(faces: &[Face], suspect: &[bool], gap: &[bool]) -> Vec<Face> {
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
    let mut is_gap = vec![false; faces.len()];
    group.iter().zip(gap).for_each(|(&group, &gap)| is_gap[group as usize] |= gap);
    let is_membrane = |group: usize| is_gap[group] && rim[group] >= RIM_EDGES_MIN;
    let is_kept = |number: usize| !suspect[number] || !is_membrane(group[number] as usize);
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
        fans.order_by_key(|fan| (std::cmp::Reverse(fan.len()), fan.iter().copied().min()));
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
