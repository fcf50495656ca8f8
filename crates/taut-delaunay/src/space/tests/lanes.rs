//! The vectors against one number at a time, and both against exact arithmetic.

use std::marker::PhantomData;

use taut_predicates::space::in_sphere_exact;
use taut_predicates::{Exact, Fused, Separate};

use super::*;
use crate::space::signs::Scalar;

/// Eight simplices over these sites, some of them ghosts, tested against a q by one path, with numbers or with pairs.
fn conflicts<S: Signs>(
    signs: S,
    pairs: bool,
    sites: &[Site],
    simplices: &[impl Slot<4>],
    q: &Site,
) -> (u32, u32) {
    let all: Vec<u32> = (0..8).collect();
    let (mut inside, mut open) = (0, 0);
    for (i, group) in all.chunks(S::WIDTH).enumerate() {
        let (here, unsure) = if pairs {
            signs
                .conflicts_in_pairs(sites, simplices, group, q)
                .unwrap_or((0, u32::MAX >> (32 - S::WIDTH)))
        } else {
            signs.conflicts(sites, simplices, group, q)
        };
        inside |= here << (i * S::WIDTH);
        open |= unsure << (i * S::WIDTH);
    }
    (inside, open)
}

/// The answers of one path: with numbers, with pairs, of the facets, and of whole numbers (inside, open, ties).
struct Masks {
    number: (u32, u32),
    pairs: (u32, u32),
    beyond: (u32, u32),
    whole: (u32, u32, u32),
}

fn all_masks<S: Signs>(signs: S, sites: &[Site], simplices: &[impl Slot<4>], q: &Site) -> Masks {
    let corners = simplices[0].vertices().map(|v| &sites[row(v)]);
    let mut whole = (0, 0, 0);
    for (i, group) in (0..8).collect::<Vec<u32>>().chunks(S::WIDTH).enumerate() {
        let nothing = (0, u32::MAX >> (32 - S::WIDTH), 0);
        let (inside, open, ties) =
            signs.conflicts_in_whole(sites, simplices, group, q).unwrap_or(nothing);
        whole.0 |= inside << (i * S::WIDTH);
        whole.1 |= open << (i * S::WIDTH);
        whole.2 |= ties << (i * S::WIDTH);
    }
    Masks {
        number: conflicts(signs, false, sites, simplices, q),
        pairs: conflicts(signs, true, sites, simplices, q),
        beyond: signs.beyond(corners, q),
        whole,
    }
}

fn masks(level: Level, sites: &[Site], simplices: &[impl Slot<4>], q: &Site) -> Masks {
    match level {
        Level::Unfiltered => all_masks(Unfiltered, sites, simplices, q),
        Level::Scalar => all_masks(Scalar::<Separate>(PhantomData), sites, simplices, q),
        #[cfg(target_arch = "x86_64")]
        Level::Four(yes) => all_masks(yes, sites, simplices, q),
        #[cfg(target_arch = "x86_64")]
        Level::Eight(yes) => all_masks(yes, sites, simplices, q),
    }
}

#[test]
fn lanes_answer_as_exact_arithmetic_or_leave_open() {
    let mut numbers = Numbers(29);
    let exact = &mut Exact::default();
    // Those that the number and the pairs decide, and those that they leave open.
    let (mut decided, mut left, mut perturbed) = ([0u32; 2], [0u32; 2], 0u32);
    for run in 0..20_000 {
        // Random; on a small grid, where ties are many; nearly on a sphere; tiny differences far from the origin.
        let coordinate = |numbers: &mut Numbers| match run % 4 {
            0 => numbers.unit(),
            1 => numbers.below(3) as f64,
            2 => numbers.unit() - 0.5,
            _ => 1000.0 + numbers.below(4) as f64 * f64::EPSILON * 512.0,
        };
        let mut points: Vec<[f64; 3]> = Vec::new();
        while points.len() < 12 {
            let mut p = [0; 3].map(|_: u8| coordinate(&mut numbers));
            if run % 4 == 2 {
                let length = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt();
                p = p.map(|x| x / length);
            }
            if !points.contains(&p) {
                points.push(p);
            }
        }
        let q = Site::new(points[11]);
        let sites: Vec<Site> = std::iter::once(Site::GHOST)
            .chain(points[..11].iter().map(|&p| Site::new(p)))
            .collect();
        let simplices: Vec<Simplex<4>> = (0..8)
            .map(|lane| {
                let order = numbers.shuffled(11);
                let mut vertices = [order[0], order[1], order[2], order[3]];
                let [a, b, c, d] = vertices.map(|v| points[v as usize]);
                if space::orient_exact(a, b, c, d, exact).is_negative() {
                    vertices.swap(0, 1);
                }
                if lane > 0 && numbers.below(4) == 0 {
                    vertices[numbers.below(4)] = GHOST;
                }
                Simplex { vertices, neighbors: [0; 4] }
            })
            .collect();
        let records = Records::new(simplices.len());
        records.all().iter().zip(&simplices).for_each(|(record, &simplex)| record.set(simplex));
        let all: Vec<_> = Level::filtered()
            .into_iter()
            .map(|level| masks(level, &sites, records.all(), &q))
            .collect();
        for Masks { number, pairs, beyond: (beyond, unsure), whole } in &all {
            for (lane, simplex) in simplices.iter().enumerate() {
                let bit = 1 << lane;
                if simplex.is_ghost() {
                    let open = number.1 & pairs.1 & whole.1;
                    assert!(open & bit != 0, "ghosts are open");
                    continue;
                }
                let [a, b, c, d] = simplex.vertices.map(|v| points[v as usize]);
                let sign = in_sphere_exact(a, b, c, d, q.point(), exact);
                for (kind, (inside, open)) in [number, pairs].into_iter().enumerate() {
                    if open & bit == 0 {
                        decided[kind] += 1;
                        let expected =
                            if inside & bit != 0 { Sign::Positive } else { Sign::Negative };
                        assert_eq!(sign, expected);
                    } else {
                        left[kind] += 1;
                    }
                }
                if run % 4 == 1 && whole.1 & bit == 0 {
                    assert_eq!(whole.2 & bit != 0, sign.is_zero(), "ties");
                    let expected = conflict_exact(a, b, c, d, q.point(), exact);
                    assert_eq!(whole.0 & bit != 0, expected);
                    perturbed += u32::from(sign.is_zero());
                }
            }
            let corners = simplices[0].vertices.map(|v| points[v as usize]);
            for i in (0..4).filter(|i| unsure & 1 << i == 0) {
                let [a, b, c] = FACETS[i].map(|k| corners[k]);
                let sign = space::orient_exact(q.point(), a, b, c, exact);
                let expected = if beyond & 1 << i != 0 { Sign::Negative } else { Sign::Positive };
                assert_eq!(sign, expected);
            }
        }
        // With fused multiplication the operations are the same one by one, so are the masks. (Compiled for any
        // processor this is a library call, which is slow and right.)
        let fused = all_masks(Scalar::<Fused>(PhantomData), &sites, records.all(), &q);
        for vectors in &all[1..] {
            assert_eq!((vectors.number, vectors.beyond), (fused.number, fused.beyond));
        }
    }
    // Every path is counted, of which there are one to three. Pairs and whole numbers are decided by those with vectors
    // alone; the one without leaves all of them open.
    let levels = Level::filtered().len() as u32;
    let vectors = levels - 1;
    let left_by_vectors = left[1] - (decided[0] + left[0]) / levels;
    assert!(
        decided[0] > 30_000 * levels && left[0] > 30_000 * levels,
        "both kinds were seen: {decided:?}, {left:?}"
    );
    assert!(
        decided[1] >= 100_000 * vectors
            && left_by_vectors >= 5000 * vectors
            && perturbed >= 5000 * vectors,
        "{decided:?}, {left:?}, {perturbed}"
    );
}
