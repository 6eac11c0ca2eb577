use super::*;

const SCENE: &str = "# A box.\ntitle = \"box\"\n\n[body] # what\nsolid = \"box\"\n\n# How.\n[initial]\nspin = { vector = [1, 0, 0] }\n\n[run]\nduration = 1\n";

#[test]
fn tables_are_replaced_where_they_stand() {
    let changed = merged(SCENE, "[initial]\nspin = { vector = [0, 2, 0] }\n").unwrap();
    assert_eq!(changed, SCENE.replace("[1, 0, 0]", "[0, 2, 0]"));
}

#[test]
fn tables_are_added_and_removed() {
    let heavy = merged(SCENE, "[gravity]\nacceleration = 9.81\n").unwrap();
    assert_eq!(heavy.trim_end(), format!("{SCENE}\n[gravity]\nacceleration = 9.81").trim_end());
    assert_eq!(merged(&heavy, "[gravity]\n").unwrap().trim_end(), SCENE.trim_end());
    assert_eq!(merged(SCENE, "[gravity]\n").unwrap(), SCENE);
}

#[test]
fn fields_are_replaced_where_they_stand() {
    let scene = "[run]\nduration = 1 # s\ninterval = 0.1\nmethod = \"kahan\"\n";
    let changed = merged(scene, "run.duration = 2\nrun.samples = 11\nrun.interval = {}\n").unwrap();
    assert_eq!(changed, "[run]\nduration = 2 # s\nmethod = \"kahan\"\nsamples = 11\n");
    let inline = merged("run = { duration = 1, rtol = 1e-9 }\n", "run.duration = 2\n").unwrap();
    assert_eq!(inline, "run = { duration = 2, rtol = 1e-9 }\n");
    assert_eq!(merged("", "run.duration = 2\n").unwrap(), "[run]\nduration = 2\n");
}

#[test]
fn invalid_toml_is_reported() {
    assert!(merged("[body", "").unwrap_err().contains("the scene cannot be read"));
    assert!(merged(SCENE, "[body").unwrap_err().contains("the change cannot be read"));
}
