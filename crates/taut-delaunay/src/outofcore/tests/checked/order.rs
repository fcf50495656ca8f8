//! Of several violations the first is told.

use super::*;

/// Two threads read the tiles, every other one each: what is told is still the first of all that is wrong.
#[test]
fn the_first_violation_is_told_for_any_number_of_threads() {
    let points = uniform::<2>(600, 53);
    let right = honest(&points, CUT);
    let is_large = |&place: &usize| {
        let counts = right.tiles[place].counts;
        counts.simplices > 10 && counts.sites > counts.copies
    };
    let places: Vec<usize> = (0..right.tiles.len()).filter(is_large).collect();
    type Damage = fn(&mut Tile<2>);
    // Met while sites are read, while simplices are judged, and while sites are distributed.
    let damages: [Damage; 3] = [
        |tile| tile.coordinates[0][0] = f64::NAN,
        |tile| tile.simplices.swap(0, 1),
        |tile| tile.duplicates.push([u64::from(u32::MAX), 0]),
    ];
    let mut told = std::collections::BTreeSet::new();
    for (i, &first) in places.iter().enumerate().take(long_or(4, 1)) {
        for &second in &places[i + 1..(i + 4).min(places.len())] {
            for (j, earlier) in damages.iter().enumerate() {
                for later in &damages {
                    let mut forgery = right.clone();
                    earlier(&mut forgery.tiles[first]);
                    let alone = damaged_with(&forgery, 1);
                    later(&mut forgery.tiles[second]);
                    for threads in [1, 2, 3, 2] {
                        let found = damaged_with(&forgery, threads);
                        assert_eq!(found, alone, "tiles {first} and {second}, {threads} threads");
                    }
                    told.insert(j);
                }
            }
        }
    }
    assert_eq!(told.len(), damages.len());
}

fn damaged_with<const D: usize>(forgery: &Forgery<D>, threads: usize) -> String {
    taut_points::thread_pool(threads).unwrap().install(|| violation(forgery)).to_string()
}
