//! The USPS digits, where the folder `TAUT_DATA` holds them as `usps_train.csv.xz`: a label, then 256 values.

use crate::test_folder::TestFolder;

#[test]
fn usps_has_the_radius_of_the_literature() {
    let folder = std::env::var_os("TAUT_DATA").map(std::path::PathBuf::from).unwrap_or_default();
    let places = ["usps_train.csv.xz", "ball/usps_train.csv.xz"].map(|name| folder.join(name));
    let Some(file) = places.iter().find(|place| place.is_absolute() && place.exists()) else {
        eprintln!(
            "skipped: usps_has_the_radius_of_the_literature, as TAUT_DATA does not hold the digits"
        );
        return;
    };
    let folder = TestFolder::new();
    let run =
        folder.taut(&format!("ball {} --columns 1- --epsilon 0 --json", file.display())).ends(0);
    let radius = run.json()["answer"]["radius"].as_f64().unwrap();
    assert!((radius - 13.479_343_686).abs() <= 1e-8, "{radius}");
    assert_eq!(run.json()["answer"]["center"].as_array().unwrap().len(), 256);
}
