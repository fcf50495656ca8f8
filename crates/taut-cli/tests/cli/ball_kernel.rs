//! `taut ball --kernel`: found, proved, drawn; options that do not belong together; forgeries refused.

use serde_json::Value;

use crate::test_folder::TestFolder;

const POINTS: &str = "0,0\n1,0\n0,1\n1,1\n0.5,0.5\n9,9\n";

fn folder() -> TestFolder {
    let folder = TestFolder::new();
    folder.put("points.csv", POINTS);
    folder
}

#[test]
fn a_gaussian_ball_is_found_proved_and_drawn() {
    let folder = folder();
    let command = "ball points.csv --kernel gaussian --gamma 0.5 -o ball.json --draw ball.svg";
    folder.taut(command).ends(0).stdout_has(&[
        "Smallest ball of a Gaussian kernel with γ = 0.5 around 6 points\n",
        "in the feature space",
        "yes; every point is inside, and the gap is proved",
    ]);
    let found: Value = serde_json::from_str(&folder.text("ball.json")).unwrap();
    assert_eq!(found["kind"], "kernel-ball");
    assert_eq!(found["answer"]["kernel"]["name"], "gaussian");
    folder.taut("verify ball.json points.csv").ends(0).stdout_has(&[
        "Verified within a gap of",
        "≤ least ≤",
        "of the squared radius",
    ]);
    let picture = folder.text("ball.svg");
    assert!(picture.contains("Ball of a gaussian kernel around 6 points"));
    folder.taut("draw ball.json points.csv -o again.svg").ends(0);
    assert_eq!(folder.text("again.svg"), picture);
    let all = folder.text("ball.json");
    folder.taut("ball points.csv --kernel gaussian --gamma 0.5 --threads 1 -o ball.json").ends(0);
    assert_eq!(folder.text("ball.json"), all);
    folder.put("moved.csv", POINTS.replace("9,9", "90,9"));
    folder.taut("verify ball.json moved.csv").ends(1);
}

#[test]
fn a_soft_ball_leaves_out_its_share() {
    let folder = folder();
    let command =
        "ball points.csv --kernel gaussian --gamma 0.5 --nu 0.2 -o soft.json --draw soft.html";
    folder.taut(command).ends(0).stdout_has(&["Soft ball (ν = 0.2)", "outside", "objective"]);
    folder.taut("verify soft.json points.csv").ends(0).stdout_has(&["outside", "1 point"]);
    let text = folder.text("soft.json");
    folder.put("forged.json", text.replace("\"nu\": 0.2", "\"nu\": 0.9"));
    folder.taut("verify forged.json points.csv").ends(1).stdout_has(&["prove a gap of"]);
}

#[test]
fn other_kernels_and_the_method_of_the_thesis() {
    let folder = folder();
    folder.taut("ball points.csv --kernel linear").ends(0).stdout_has(&["squared radius", "40.5"]);
    folder
        .taut("ball points.csv --kernel polynomial --degree 2 --offset 1 --gamma 0.1 -o p.json")
        .ends(0)
        .stdout_has(&["the kernel (0.1 x·y + 1)^2"]);
    folder.taut("verify p.json points.csv").ends(0);
    folder
        .taut("ball points.csv --kernel gaussian --thesis-steps 100 -o t.json")
        .ends(0)
        .stdout_has(&["thesis"]);
    folder.taut("verify t.json points.csv").ends(0);
    // Fewer steps than were asked for are no success.
    folder.taut("ball points.csv --kernel gaussian --thesis-steps 100 --max-passes 9").ends(3);
    folder.put("gram.csv", "1,0.5,0\n0.5,1,0.25\n0,0.25,1\n");
    folder.taut("ball gram.csv --kernel precomputed -o g.json --draw g.svg").ends(0);
    folder.taut("verify g.json gram.csv").ends(0).stdout_has(&["evidence"]);
    assert!(folder.text("g.svg").contains("squared distance in the feature space"));
}

#[test]
fn options_that_do_not_belong_together_are_refused() {
    let folder = folder();
    for (command, said) in [
        ("ball points.csv --kernel linear --gamma 2", "`--gamma` is no parameter"),
        ("ball points.csv --kernel gaussian --degree 2", "`--degree` is no parameter"),
        ("ball points.csv --kernel gaussian --gamma -1", "`--gamma` is -1"),
        ("ball points.csv --kernel gaussian --nu 2", "`--nu` is 2"),
        ("ball points.csv --kernel gaussian --method thesis-pure", "--thesis-steps"),
        ("ball points.csv --kernel precomputed", "square"),
    ] {
        folder.taut(command).ends(2).stderr_has(&[said]);
    }
    for command in [
        "ball points.csv --gamma 2",
        "ball points.csv --kernel gaussian --nu 0.1 --thesis-steps 9",
        "ball points.csv --kernel gaussian --epsilon 0.1 --thesis-steps 9",
        "ball points.csv --kernel gaussian --balls",
        "ball points.csv --kernel cosine",
    ] {
        folder.taut(command).ends(2);
    }
}
