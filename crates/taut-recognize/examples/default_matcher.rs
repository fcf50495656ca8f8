//! Learns the matcher of `Matcher::of_synthetic_hands` and prints its JSON:
//! `cargo run --release -p taut-recognize --example default_matcher > crates/taut-recognize/src/hand/default_matcher.json`.

use taut_points::Points;
use taut_points::parallel::ParallelSlice;
use taut_recognize::classify::Labeled;
use taut_recognize::hand::synthetic::Generator;
use taut_recognize::hand::{Hand, HandOptions, PROFILE};
use taut_recognize::template::{Matcher, MatcherOptions};

/// Seeds of the generator.
const SEEDS: [u64; 4] = [501, 502, 503, 504];
/// People of each seed.
const PEOPLE: u64 = 70;
/// Scans of each person.
const SCANS: u64 = 10;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let each = |seed: u64| {
        (0..PEOPLE).flat_map(move |person| (0..SCANS).map(move |scan| (seed, person, scan)))
    };
    let all: Vec<(u64, u64, u64)> = SEEDS.into_iter().flat_map(each).collect();
    // Scans that cannot be measured are left out.
    let measure = |&(seed, person, scan): &(u64, u64, u64)| {
        let made = Generator { seed, ..Generator::default() }.scan(person, scan);
        let hand = Hand::from_rgb(&made.image, &HandOptions::default()).ok()?;
        Some((format!("{seed}-{person:02}"), hand.profile))
    };
    let measured: Vec<(String, [f64; PROFILE])> = all.par_iter().filter_map(measure).collect();
    let mut names: Vec<String> = measured.iter().map(|(name, _)| name.clone()).collect();
    names.sort();
    names.dedup();
    let place = |name: &String| names.partition_point(|other| other < name) as u32;
    let labels: Vec<u32> = measured.iter().map(|(name, _)| place(name)).collect();
    let values: Vec<f64> = measured.iter().flat_map(|(_, profile)| profile).copied().collect();
    let options = MatcherOptions {
        source: format!("{} synthetic hands", names.len()),
        ..MatcherOptions::default()
    };
    let data = Labeled::new(Points::new(&values, PROFILE)?, &labels, &names)?;
    println!("{}", Matcher::train(data, &options)?.to_json());
    Ok(())
}
