//! The nearest of points in space, beside kiddo's immutable tree.

use super::*;

/// One by one at random places, by batch, eight at once; building too.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let (n, asked) = context.size((16_000_000, 100_000), (100_000, 10_000));
    let mut draw = Draw(1);
    let points = draw.points(n);
    let places = draw.points(asked);
    let mut build = Lanes::default();
    let ours = build.time("taut", || KdTree::new(&points))?;
    let theirs: ImmutableKdTree<f64, 3> = build
        .time("kiddo", || ImmutableKdTree::new_from_slice(&points))
        .map_err(|error| anyhow!("kiddo: {error:?}"))?;
    out.table(&format!("{n} points built once"), build.table(n));
    let (mut one, mut eight) = (Lanes::default(), Lanes::default());
    let few = &places[..asked / 5];
    for _ in 0..context.runs {
        let found: Option<Vec<_>> =
            one.time("taut", || places.iter().map(|&place| ours.nearest(place)).collect());
        let found = found.context("no point is nearest")?;
        let peer: Vec<(f64, u64)> = one.time("kiddo", || {
            let nearest = |place| {
                let found = theirs.query(place).nearest_one::<SquaredEuclidean<f64>>().execute();
                (found.distance, u64::from(found.item))
            };
            places.iter().map(nearest).collect()
        });
        // Random points have no ties.
        let same = found.iter().map(|near| (near.distance2, u64::from(near.row)));
        ensure!(same.eq(peer), "taut and kiddo differ");
        let batch = one.time("taut, batch", || ours.nearest_all(&places));
        ensure!(batch.into_iter().eq(found.into_iter().map(Some)), "a batch differs");
        let found: Vec<f64> = eight.time("taut", || {
            few.iter()
                .flat_map(|&place| ours.nearest_k(place, 8))
                .map(|near| near.distance2)
                .collect()
        });
        let most = NonZero::new(8).context("eight")?;
        let peer: Vec<f64> = eight.time("kiddo", || {
            let nearest =
                |place| theirs.query(place).nearest_n::<SquaredEuclidean<f64>>(most).execute();
            few.iter().flat_map(nearest).map(|near| near.distance).collect()
        });
        ensure!(found == peer, "the eight nearest differ");
    }
    out.table(&format!("the nearest of {asked} random places"), one.table(asked));
    out.table(&format!("the eight nearest of {} of them", few.len()), eight.table(few.len()));
    let ratio = one.faster("taut", "kiddo");
    out.at_least("one by one: kiddo over taut", ratio, [1.0, 1.5], Unit::Times);
    Ok(())
}
