//! Tests what the tests of centers share: smallest balls by the ellipsoid method, a brute force over all colorings, and a
//! judge that measures every row and replays every proof with code of its own.
#![allow(dead_code, unreachable_pub)] // each test binary uses a part

use taut_certify::{Centers, HeldOut, Items, LowerBound, Solution};
use taut_enclose::CentersOptions;

/// Returns how far a row reaches from a center.
pub fn reach(row: &[f64], center: &[f64], items: Items, weights: bool) -> f64 {
    let d = row.iter().zip(center).map(|(x, c)| (x - c) * (x - c)).sum::<f64>().sqrt();
    match items {
        Items::Balls => d + row[row.len() - 1],
        _ if weights => d * row[row.len() - 1],
        _ => d,
    }
}

/// The radius of the smallest ball of some rows, to about 1e-10: the largest reach is a convex function, which the ellipsoid method
/// minimizes, in rounds that start from ever smaller balls around the best center so far. Slow, and unlike the solver in every step.
pub fn smallest(rows: &[&[f64]], dim: usize, items: Items, weights: bool) -> f64 {
    let d = dim as f64;
    let farthest = |center: &[f64]| -> (usize, f64) {
        let reaches = rows.iter().map(|row| reach(row, center, items, weights));
        reaches.enumerate().fold((0, -1.0), |most, (i, r)| if r > most.1 { (i, r) } else { most })
    };
    // The optimum is in the hull of the rows.
    let mut best = (rows[0][..dim].to_vec(), farthest(&rows[0][..dim]).1);
    let length =
        |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt();
    let spread = rows.iter().map(|row| length(&row[..dim], &rows[0][..dim])).fold(0.0, f64::max);
    if rows.len() == 1 || spread == 0.0 {
        return best.1;
    }
    for round in [1.0, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
        let mut center = best.0.clone();
        let mut shape = vec![0.0; dim * dim];
        (0..dim).for_each(|j| shape[j * dim + j] = (1.01 * spread * round).powi(2));
        for _ in 0..30 * dim * (dim + 1) + 30 {
            let (far, value) = farthest(&center);
            if value < best.1 {
                best = (center.clone(), value);
            }
            let row = rows[far];
            let distance = length(&row[..dim], &center);
            if distance == 0.0 {
                return best.1;
            }
            let g: Vec<f64> = (0..dim).map(|j| (center[j] - row[j]) / distance).collect();
            let pg: Vec<f64> =
                (0..dim).map(|a| (0..dim).map(|b| shape[a * dim + b] * g[b]).sum()).collect();
            let gpg: f64 = g.iter().zip(&pg).map(|(g, p)| g * p).sum();
            if gpg <= (1e-14 * spread).powi(2) {
                break;
            }
            (0..dim).for_each(|j| center[j] -= pg[j] / gpg.sqrt() / (d + 1.0));
            if dim == 1 {
                shape[0] /= 4.0;
                continue;
            }
            let factor = d * d / (d * d - 1.0);
            for a in 0..dim {
                for b in 0..dim {
                    let cut = 2.0 / (d + 1.0) * pg[a] * pg[b] / gpg;
                    shape[a * dim + b] = factor * (shape[a * dim + b] - cut);
                }
            }
        }
    }
    best.1
}

/// The least radius for k centers that leave out z rows, for at most 12 rows: the smallest balls of all parts, then the best
/// coloring of all parts.
pub fn brute_force(
    values: &[f64],
    columns: usize,
    items: Items,
    weights: bool,
) -> impl Fn(usize, usize) -> f64 {
    let dim = if items == Items::Balls || weights { columns - 1 } else { columns };
    let rows: Vec<&[f64]> = values.chunks_exact(columns).collect();
    let n = rows.len();
    let all = 1usize << n;
    let mut radius = vec![0.0f64; all];
    for part in 1..all {
        // A part has the radius of some d + 1 of its items (Helly), so that larger ones need no ball of their own.
        let members: Vec<usize> = (0..n).filter(|i| part >> i & 1 == 1).collect();
        radius[part] = if members.len() <= dim + 1 {
            let rows: Vec<&[f64]> = members.iter().map(|&i| rows[i]).collect();
            smallest(&rows, dim, items, weights)
        } else {
            members.iter().map(|i| radius[part & !(1 << i)]).fold(0.0, f64::max)
        };
    }
    let mut tables = vec![radius.clone()];
    for k in 1..n {
        let before = &tables[k - 1];
        let mut table = before.clone();
        for part in 1..all {
            // The cluster of the lowest item.
            let low = part & part.wrapping_neg();
            let rest = part ^ low;
            let mut sub = rest;
            loop {
                let cluster = low | sub;
                let others = part ^ cluster;
                let value =
                    if others == 0 { radius[cluster] } else { radius[cluster].max(before[others]) };
                table[part] = table[part].min(value);
                if sub == 0 {
                    break;
                }
                sub = (sub - 1) & rest;
            }
        }
        tables.push(table);
    }
    move |k, z| {
        let table = &tables[k.min(n) - 1];
        (0..all)
            .filter(|part: &usize| part.count_ones() as usize + z >= n)
            .map(|part| table[part])
            .fold(f64::INFINITY, f64::min)
    }
}

/// Judges an answer from the rows alone. Errors are sentences.
pub fn judge(
    values: &[f64],
    columns: usize,
    k: usize,
    options: &CentersOptions<'_>,
    found: &Solution<Centers>,
) -> Result<(), String> {
    let (answer, certificate) = (&found.answer, &found.certificate);
    let (items, weights) = (certificate.items, certificate.weights);
    let dim = if items == Items::Balls || weights { columns - 1 } else { columns };
    let rows: Vec<&[f64]> = values.chunks_exact(columns).collect();
    if answer.centers.len() > k || answer.centers.is_empty() {
        return Err(format!("{} centers", answer.centers.len()));
    }
    if answer.centers.iter().any(|c| c.len() != dim || c.iter().any(|x| !x.is_finite())) {
        return Err("a center is no point".into());
    }
    if answer.outliers.len() as u64 > options.outliers
        || !answer.outliers.is_sorted_by(|a, b| a < b)
    {
        return Err(format!("outliers {:?}", answer.outliers));
    }
    for (id, row) in rows.iter().enumerate() {
        let reaches = || answer.centers.iter().map(|c| reach(row, c, items, weights));
        let nearest = reaches().fold(f64::INFINITY, f64::min);
        let is_out = answer.outliers.binary_search(&(id as u64)).is_ok();
        if !is_out && nearest > answer.radius {
            return Err(format!("row {id} reaches {nearest}"));
        }
        if options.assignment && reaches().nth(answer.assignment[id] as usize) != Some(nearest) {
            return Err(format!("row {id} is assigned to {}", answer.assignment[id]));
        }
    }
    if options.assignment != (answer.assignment.len() == rows.len()) {
        return Err("the assignment has another length".into());
    }
    let gap = if answer.radius == 0.0 { 0.0 } else { answer.radius / answer.lower_bound - 1.0 };
    if gap.min(f64::MAX) > certificate.gap * (1.0 + 1e-9) + 4e-16 {
        return Err(format!("gap {gap} against {}", certificate.gap));
    }
    if answer.lower_bound == 0.0 {
        return Ok(());
    }
    let set: Vec<&[f64]> = certificate.core_set.iter().map(|&id| rows[id as usize]).collect();
    let mut replay = Replay {
        set,
        dim,
        items,
        weights,
        k,
        bound: answer.lower_bound * (1.0 - 1e-9),
        clusters: vec![],
        left: options.outliers,
        out: vec![],
        held_out: vec![],
        read: 0,
        given: vec![false; certificate.core_set.len()],
    };
    match &certificate.proof {
        LowerBound::Separated => {
            let n = certificate.core_set.len();
            if n as u64 <= k as u64 + options.outliers {
                return Err(format!("{n} items apart are too few"));
            }
            for a in 0..n {
                for b in 0..a {
                    if !replay.is_refuted(&[a, b]) {
                        return Err(format!("{a} and {b} are not apart"));
                    }
                }
            }
        }
        LowerBound::Branches { items } => {
            replay.follow(items)?;
            replay.is_at_end(items)?;
        }
        LowerBound::Avoiding { items: log, held_out } => {
            if items != Items::Points || weights || dim != 2 {
                return Err("items left out refute only points of the plane".into());
            }
            replay.held_out = held_out.iter().rev().copied().collect();
            replay.follow(log)?;
            replay.is_at_end(log)?;
        }
        LowerBound::Nogoods { .. } => {
            return Err("trees of this size are not large enough for nogoods".into());
        }
    }
    Ok(())
}

struct Replay<'a> {
    set: Vec<&'a [f64]>,
    dim: usize,
    items: Items,
    weights: bool,
    k: usize,
    bound: f64,
    clusters: Vec<Vec<usize>>,
    left: u64,
    out: Vec<usize>,
    /// The last one first.
    held_out: Vec<HeldOut>,
    /// Branches so far.
    read: usize,
    given: Vec<bool>,
}

impl Replay<'_> {
    fn is_refuted(&self, cluster: &[usize]) -> bool {
        let rows: Vec<&[f64]> = cluster.iter().map(|&i| self.set[i]).collect();
        smallest(&rows, self.dim, self.items, self.weights) >= self.bound
    }

    fn is_at_end(&self, log: &[u32]) -> Result<(), String> {
        match self.read == log.len() && self.held_out.is_empty() {
            true => Ok(()),
            false => Err("the log goes on".into()),
        }
    }

    /// A center of a ball of the bound's radius that holds a cluster and nothing that is left out, clearly: if there is one, there is
    /// one where two circles about the points meet.
    fn is_avoidable(&self, cluster: usize) -> Option<[f64; 2]> {
        let place = |&item: &usize| [self.set[item][0], self.set[item][1]];
        let members: Vec<[f64; 2]> = self.clusters[cluster].iter().map(place).collect();
        let left_out: Vec<[f64; 2]> = self.out.iter().map(place).collect();
        // A ball holds what it holds strictly, and so its copies.
        if left_out.iter().any(|out| members.contains(out)) {
            return None;
        }
        let all: Vec<[f64; 2]> = members.iter().chain(&left_out).copied().collect();
        let distance = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
        let is_center = |c: &[f64; 2]| {
            members.iter().all(|&m| distance(m, *c) <= self.bound * (1.0 + 1e-12))
                && left_out.iter().all(|&x| distance(x, *c) >= self.bound * (1.0 - 1e-12))
        };
        let pairs = all.iter().flat_map(|&a| all.iter().map(move |&b| (a, b)));
        let mut meets = pairs.filter_map(|(a, b)| {
            let apart = distance(a, b);
            let across = (self.bound * self.bound - apart * apart / 4.0).sqrt() / apart;
            let (x, y) = (across * (b[1] - a[1]), across * (a[0] - b[0]));
            across.is_finite().then_some([(a[0] + b[0]) / 2.0 + x, (a[1] + b[1]) / 2.0 + y])
        });
        meets.find(is_center)
    }

    /// Follows the log: the items of the nodes in preorder, each given to all places that do not refute it.
    fn follow(&mut self, log: &[u32]) -> Result<(), String> {
        if let Some(end) = self.held_out.pop_if(|end| end.at == self.read as u64) {
            return match self.is_avoidable(end.cluster as usize) {
                Some(center) => Err(format!("{center:?} avoids all that is left out")),
                None => Ok(()),
            };
        }
        let item = *log.get(self.read).ok_or("the log ends early")? as usize;
        self.read += 1;
        if std::mem::replace(&mut self.given[item], true) {
            return Err(format!("{item} is given already"));
        }
        for at in 0..self.clusters.len() {
            self.clusters[at].push(item);
            if !self.is_refuted(&self.clusters[at]) {
                self.follow(log)?;
            }
            self.clusters[at].pop();
        }
        if self.clusters.len() < self.k {
            self.clusters.push(vec![item]);
            if !self.is_refuted(&[item]) {
                self.follow(log)?;
            }
            self.clusters.pop();
        }
        if self.left > 0 {
            self.left -= 1;
            self.out.push(item);
            self.follow(log)?;
            self.out.pop();
            self.left += 1;
        }
        self.given[item] = false;
        Ok(())
    }
}
