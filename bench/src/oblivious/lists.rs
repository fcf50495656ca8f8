//! A linked list in order.

use anyhow::{Result, ensure};
use serde_json::{Value, json};
use taut_oblivious::{NO_NODE, list_order};

use super::draw::Draw;
use super::lanes::{Lanes, have_memory};
use crate::context::Context;
use crate::goals::Goals;
use crate::stats::times;

/// A list through nodes in random order, beside following it link by link.
pub(super) fn run(context: &Context) -> Result<Value> {
    let n: u32 = if context.quick { 100_000 } else { 10_000_000 };
    let order = Draw(1).permutation(n);
    let mut next = vec![NO_NODE; n as usize];
    for link in order.windows(2) {
        next[link[0] as usize] = link[1];
    }
    let mut lanes = Lanes::default();
    for _ in 0..context.runs {
        have_memory(32 * next.len())?;
        let lists = lanes.time("taut", || list_order(&next))?;
        ensure!(lists.order == order, "taut: another order");
        have_memory(32 * next.len())?;
        let chased: Vec<u32> = lanes.time("link by link", || {
            let after = |node: &u32| Some(next[*node as usize]).filter(|&node| node != NO_NODE);
            std::iter::successors(order.first().copied(), after).collect()
        });
        ensure!(chased == order, "link by link: another order");
    }
    println!("{n} nodes in random order\n\n{}", lanes.table(n as usize));
    let mut goals = Goals::default();
    let ratio = lanes.faster("taut", "link by link");
    goals.aim("link by link over taut at least 5".into(), times(ratio), ratio >= 5.0);
    Ok(json!({ "n": n, "lanes": lanes.json(n as usize), "goals": goals.json() }))
}
