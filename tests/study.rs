//! What accuracy costs in time: the numbers that do not depend on the clock.

use std::time::Duration;

use pellucid::image::Image;
use pellucid::integrate;
use pellucid::plan::{March, Method, SampleRule};
use pellucid::scene::Scene;
use pellucid::study::{Candidate, Errors, Family, Peer, Report, Settings, Study, Target, choose_method, study};
use pellucid::volume::Volume;

use crate::support::scenes::{headlight, rough_volume, scene_around, two_colors};

fn subject() -> (Volume, Scene) {
    let volume = rough_volume(6);
    let scene = scene_around(&volume, vec![two_colors()], Some(headlight()), [16, 12]);
    (volume, scene)
}

fn studied(seconds: u64) -> Study {
    let (volume, scene) = subject();
    let settings =
        Settings { time: Duration::from_secs(seconds), tolerance: 1.0 / 255.0, pixels: 100, room_for_f32: true };
    study(&volume, &scene, &settings, &mut [], &|_, share| assert!((0.0..=1.0).contains(&share), "a share of {share}"))
        .expect("every setting renders light")
}

#[test]
fn the_exact_integrator_keeps_each_tolerance_and_finer_steps_are_more_accurate() {
    let study = studied(2);
    assert!(study.oracle_pixels > 0 && study.oracle_pixels <= 100, "found {} pixels", study.oracle_pixels);
    for m in &study.settings {
        if let Method::Exact(exact) = m.rung.method {
            let found = m.errors.largest;
            assert!(found <= exact.tolerance, "{}: an error of {found:.1e}", m.rung.setting);
        }
    }
    for family in [Family::Left, Family::Midpoint, Family::Trapezoid, Family::Jitter] {
        let rms: Vec<f64> = study.settings.iter().filter(|m| m.rung.family == family).map(|m| m.errors.rms).collect();
        let (first, last) = (rms[0], rms[rms.len() - 1]);
        assert!(rms.len() < 7 || last < 0.1 * first, "{}: RMS errors of {rms:?}", family.name());
    }
    let on_front = study.front.iter().map(|&place| study.settings[place].errors.largest).collect::<Vec<_>>();
    assert!(on_front.windows(2).all(|pair| pair[1] < pair[0]), "errors fall along the front: {on_front:?}");
}

#[test]
fn choices_that_change_no_picture_change_no_error() {
    let study = studied(2);
    let cost = |choice: &'static str| study.costs.iter().filter(move |cost| cost.choice == choice);
    for choice in ["all threads instead of one", "empty-space skipping"] {
        for cost in cost(choice) {
            let [without, with] = cost.errors.map(|errors| errors.largest);
            // Another kernel may round otherwise.
            assert!((without - with).abs() < 1e-5, "{choice}, {}: errors of {without} and {with}", cost.by);
        }
    }
    let left_out = |choice: &str| study.left_out.iter().any(|left| left.what.starts_with(choice));
    for choice in ["shading", "jitter", "early termination at 1/255", "twice the width and height"] {
        assert!(cost(choice).next().is_some() || left_out(choice), "{choice} is neither measured nor left out");
    }
    assert!(cost("shading").all(|cost| cost.rounds > 0 && cost.errors[0].pixels > 0), "found {:#?}", study.costs);
}

#[test]
fn what_the_exact_integrator_passes_over_is_measured_as_that_of_the_march_and_stays_within_the_tolerance() {
    let study = studied(4);
    let by = |choice: &str| -> Vec<&str> {
        let measured = study.costs.iter().filter(|cost| cost.choice == choice).map(|cost| (&cost.by, &cost.errors));
        measured
            .map(|(by, errors)| {
                let largest = errors.map(|errors| errors.largest);
                let within = by != "exact" || largest.iter().all(|&error| error <= study.tolerance);
                assert!(within, "{choice}, {by}: errors of {largest:?}");
                by.as_str()
            })
            .collect()
    };
    let march = "march at 1/2 voxel";
    assert_eq!(by("empty-space skipping"), [march, "exact"], "left out: {:?}", study.left_out);
    assert_eq!(by("early termination at 1/255"), [march], "left out: {:?}", study.left_out);
    assert_eq!(by("early termination within the bound"), ["exact"], "left out: {:?}", study.left_out);
}

#[test]
fn without_time_the_coarsest_of_each_family_is_measured_and_the_rest_is_said_to_be_left_out() {
    let study = studied(0);
    for family in Family::ALL {
        let measured = study.settings.iter().filter(|m| m.rung.family == family).count();
        assert_eq!(measured, 1, "{}: the first and no other", family.name());
    }
    let (count, costs) = (study.left_out.len(), study.costs.len());
    assert!(count > 28 && costs == 0, "found {count} left out and {costs} costs");
}

#[test]
fn tables_chart_and_json_hold_every_setting() {
    let study = studied(1);
    let report = Report(&study);
    let (markdown, csv) = (report.markdown(), report.settings_csv());
    for m in &study.settings {
        assert!(markdown.contains(&m.rung.setting) && csv.contains(&m.rung.setting), "{} is missing", m.rung.setting);
    }
    assert_eq!(csv.lines().count(), 1 + study.settings.len(), "one line each, and a header");
    assert_eq!(report.costs_csv().lines().count(), 1 + study.costs.len(), "one line each, and a header");
    let points: usize = report.chart().series.iter().map(|series| series.points.len()).sum();
    assert_eq!(points, study.settings.len(), "points of the chart");
    let json: serde_json::Value = serde_json::from_str(&report.json().expect("JSON")).expect("valid JSON");
    let first = &json["study"]["settings"][0];
    assert!(first["seconds"].as_f64().is_some_and(|s| s > 0.0), "found {first}");
}

/// Another program that happens to march as we do.
struct Twin {
    volume: Volume,
    scene: Scene,
}

impl Peer for Twin {
    fn name(&self) -> String {
        "twin".to_owned()
    }

    fn render(&mut self, step_mm: f64) -> pellucid::Result<(Image, f64)> {
        let method = Method::March(March::plain(SampleRule::Left, step_mm));
        let rendered = integrate::render(&self.volume, &self.scene, &method, &|_| ())?;
        Ok((rendered.image, 1e-4 / step_mm))
    }
}

#[test]
fn another_program_is_measured_by_the_same_steps_against_the_same_pixels() {
    let (volume, scene) = subject();
    let settings = Settings { time: Duration::from_secs(2), tolerance: 1.0 / 255.0, pixels: 100, room_for_f32: false };
    let twin: Box<dyn Peer> = Box::new(Twin { volume: volume.clone(), scene: scene.clone() });
    let study = study(&volume, &scene, &settings, &mut [twin], &|_, _| ()).expect("a study");
    let ours: Vec<&Errors> =
        study.settings.iter().filter(|m| m.rung.family == Family::Left).map(|m| &m.errors).collect();
    let theirs: Vec<&Errors> = study.peers.iter().map(|m| &m.errors).collect();
    let both = ours.len().min(theirs.len());
    assert!(both > 0 && ours[..both] == theirs[..both], "errors of {ours:?}, and of the same by a twin {theirs:?}");
    assert!(study.peers.iter().all(|m| m.seconds > 0.0 && m.repeats > 0), "found {:#?}", study.peers);
    let report = Report(&study);
    assert!(report.markdown().contains("twin, step 4") && report.settings_csv().contains("\"twin\""), "in the tables");
    assert!(report.chart().series.iter().any(|series| series.name == "twin"), "in the chart");
}

#[test]
fn what_is_chosen_for_a_tolerance_keeps_it_on_the_sample() {
    let (volume, scene) = subject();
    let tolerance = 2e-3;
    let choice = choose_method(&volume, &scene, Target::Tolerance(tolerance), &|_| ()).expect("a choice");
    let chosen = choice.candidates.iter().find(|c| c.rung == choice.rung).expect("the exact integrator is a candidate");
    assert!(choice.met && chosen.largest_error <= chosen.room(tolerance), "found {chosen:?}: {}", choice.because);
    let within = |c: &&Candidate| c.largest_error <= c.room(tolerance);
    let quicker = choice.candidates.iter().filter(within).find(|c| c.seconds < chosen.seconds);
    assert_eq!(quicker, None, "a quicker one keeps it too");
}

#[test]
fn what_is_chosen_for_a_time_that_nothing_keeps_is_said_not_to_be_as_wanted() {
    let (volume, scene) = subject();
    let choice = choose_method(&volume, &scene, Target::Seconds(1e-12), &|_| ()).expect("a choice");
    assert!(!choice.met && choice.because.contains("none of"), "found {}", choice.because);
}
