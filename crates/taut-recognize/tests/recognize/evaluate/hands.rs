//! Hands in the protocol, and the people that error rates of hands are measured on.

use taut_recognize::hand::synthetic::Generator;

/// Error rates of recognition are measured on these people: what draws them must not change once a classifier was scored. The pixels of
/// scans are frozen beside the extraction.
#[test]
fn people_and_their_poses_are_frozen() {
    let generator = Generator { seed: 1, ..Default::default() };
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    // Seven digits: the last ones may depend on the mathematical library of the system.
    let mut add = |values: &[f64]| {
        let words = values.iter().map(|value| format!("{value:.6e} "));
        for byte in words.collect::<String>().bytes() {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    };
    for id in 0..50 {
        let person = generator.person(id);
        add(&person.body);
        add(&person.lengths);
        add(&person.breadths);
    }
    for (person, scan) in [(0, 0), (1, 4), (2, 7)] {
        add(generator.scan(person, scan).truth.tips.as_flattened());
    }
    assert_eq!(format!("{hash:016x}"), "2e6de9474a7eed2b");
}
