use taut_points::Monitor;

use super::disks::{Disks, Growing};
use super::each;
use super::strip::{least_strip, reduce_to_hull};
use crate::Error;

const MOST: usize = 1 << 16;
const LOOKS: usize = 512;
const STEP: f64 = 1.15;

/// An estimate of the least local feature size.
pub(super) fn least(
    samples: &[[f64; 2]],
    radii: &[f64],
    monitor: &Monitor<'_>,
) -> Result<f64, Error> {
    let n = samples.len();
    let mut order: Vec<u32> = (0..n as u32).collect();
    order.sort_by(|&a, &b| radii[a as usize].total_cmp(&radii[b as usize]));
    let mut thinned: Vec<u32> = order.iter().step_by(n.div_ceil(MOST).max(1)).copied().collect();
    let mut looks: Vec<u32> = order.iter().step_by(n.div_ceil(LOOKS).max(1)).copied().collect();
    thinned.sort_unstable();
    looks.sort_unstable();
    let _ = thinned;
    let disks = Disks::over(samples);
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for s in samples {
        for k in 0..2 {
            low[k] = low[k].min(s[k]);
            high[k] = high[k].max(s[k]);
        }
    }
    let diameter = if n == 0 { 0.0 } else { (high[0] - low[0]).hypot(high[1] - low[1]) };
    let mut found = each(looks.len(), monitor, |i| {
        let s = looks[i] as usize;
        let mut disk = Growing::around(&disks, s);
        let (mut radius, mut taken, mut hull) = (radii[s], 0, Vec::new());
        let (mut best, mut size) = (0.0, diameter);
        while radius > 0.0 && radius < 2.0 * diameter {
            let near = disk.within(radius);
            hull.extend(near[taken..].iter().map(|sample| sample.1));
            taken = near.len();
            reduce_to_hull(&mut hull);
            let width = least_strip(&hull).width;
            let flat = radius / width;
            if flat > best {
                (best, size) = (flat, (flat * radius).min(diameter));
            } else if flat < 1.25 {
                return size.min(radius / 2.0);
            }
            radius *= STEP;
        }
        size
    })?;
    found.sort_by(f64::total_cmp);
    if std::env::var("DBG").is_ok() {
        let q = |f: f64| found[((found.len() - 1) as f64 * f) as usize];
        eprintln!(
            "feature q0 {:.3} q.01 {:.3} q.05 {:.3} q.1 {:.3} q.5 {:.3}",
            q(0.),
            q(0.01),
            q(0.05),
            q(0.1),
            q(0.5)
        );
    }
    Ok(found.get(found.len() / 100).copied().unwrap_or(0.0))
}
