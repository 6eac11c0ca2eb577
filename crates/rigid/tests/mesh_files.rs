//! Mesh file formats: the same box in each dialect, and no panic for any bytes.

use polhode_ga::Vector;
use polhode_rigid::body::mesh::MeshFormat;
use polhode_rigid::{Amount, TriangleMesh};
use proptest::prelude::*;
use std::path::PathBuf;

/// The corners of a box 1 x 2 x 3 and its twelve triangles, outward.
const LENGTHS: [f32; 3] = [1.0, 2.0, 3.0];
const QUADS: [[usize; 4]; 6] =
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

fn corners() -> Vec<[f32; 3]> {
    (0..8).map(|k| [0, 1, 2].map(|i| if k >> i & 1 == 1 { LENGTHS[i] } else { 0.0 })).collect()
}

fn triangles() -> Vec<[usize; 3]> {
    QUADS.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect()
}

fn reference() -> TriangleMesh {
    let vertices = corners().iter().map(|c| Vector(c.map(f64::from))).collect();
    TriangleMesh::new(vertices, triangles().iter().map(|t| t.map(|i| i as u32)).collect()).unwrap()
}

/// Parsed, it is the reference box to the last bit of its body.
fn assert_box(bytes: &[u8], format: MeshFormat) {
    let mesh = TriangleMesh::parse(bytes, format, "box").unwrap();
    assert_eq!(mesh.faces().len(), 12);
    assert_eq!(mesh.body(Amount::Density(2.0)), reference().body(Amount::Density(2.0)));
}

fn text_stl() -> String {
    let mut text = String::from("solid box of facets\n");
    for t in triangles() {
        text += " facet normal 0 0 0\n  outer loop\n";
        for [x, y, z] in t.map(|i| corners()[i]) {
            text += &format!("   vertex {x:e} {y} {z}\n");
        }
        text += "  endloop\n endfacet\n";
    }
    text + "endsolid box of facets\n"
}

fn binary_stl(header: &[u8]) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, b' ');
    bytes.extend(12_u32.to_le_bytes());
    for t in triangles() {
        bytes.extend([0; 12]);
        for x in t.iter().flat_map(|&i| corners()[i]) {
            bytes.extend(x.to_le_bytes());
        }
        bytes.extend([0xab, 0xcd]);
    }
    bytes
}

fn obj() -> String {
    let mut text = String::from("# a box\nmtllib box.mtl\no box\n");
    for [x, y, z] in corners() {
        text += &format!("v {x} {y} {z}\n");
    }
    text += "vn 0 0 1\nvt 0 0\ng all\nusemtl red # bright\ns off\n";
    for (k, [a, b, c, d]) in QUADS.iter().map(|q| q.map(|i| i + 1)).enumerate() {
        text += &match k {
            0 => format!("f {a} {b} {c} {d}\n"),
            1 => format!("f {a}/1 {b}/1 {c}/1 {d}/1\n"),
            2 => format!("f {a}//1 {b}//1 {c}//1 {d}//1 # a side\n"),
            3 => format!("f {a}/1/1 {b}/1/1 \\\r\n {c}/1/1 {d}/1/1\r\n"),
            _ => format!("f {} {} {} {}\n", a as i64 - 9, b as i64 - 9, c as i64 - 9, d as i64 - 9),
        };
    }
    text + "l 1 2\np 1\n"
}

fn text_ply() -> String {
    let mut text = String::from(
        "ply\nformat ascii 1.0\ncomment a box\nobj_info none\nelement material 2\nproperty list uchar float shades\n\
         element vertex 8\nproperty double z\nproperty uchar red\nproperty double x\nproperty float y\n\
         element empty 4000000000\nelement face 6\nproperty uchar flags\nproperty list uchar int vertex_indices\n\
         end_header\n2 0.5 0.25\n0\n",
    );
    for [x, y, z] in corners() {
        text += &format!("{z} 255 {x} {y}\n");
    }
    for [a, b, c, d] in QUADS {
        text += &format!("7 4 {a} {b} {c} {d}\n");
    }
    text
}

/// Faces first, and unused lists before and after the used properties.
fn binary_ply(big_endian: bool) -> Vec<u8> {
    let order = if big_endian { "big" } else { "little" };
    let header = format!(
        "ply\r\nformat binary_{order}_endian 1.0\r\nelement face 6\r\nproperty list ushort short texture\r\n\
         property list uint uint16 vertex_index\r\nelement vertex 8\r\nproperty float32 x\r\nproperty float y\r\n\
         property list int8 double weights\r\nproperty double z\r\nend_header\r\n"
    );
    let mut bytes = header.into_bytes();
    let mut put = |number: &[u8]| match big_endian {
        true => bytes.extend(number),
        false => bytes.extend(number.iter().rev()),
    };
    for quad in QUADS {
        put(&2_u16.to_be_bytes());
        put(&(-3_i16).to_be_bytes());
        put(&9_i16.to_be_bytes());
        put(&4_u32.to_be_bytes());
        quad.iter().for_each(|&i| put(&(i as u16).to_be_bytes()));
    }
    for [x, y, z] in corners() {
        put(&x.to_be_bytes());
        put(&y.to_be_bytes());
        put(&1_i8.to_be_bytes());
        put(&0.5_f64.to_be_bytes());
        put(&f64::from(z).to_be_bytes());
    }
    bytes
}

#[test]
fn stl() {
    assert_box(text_stl().as_bytes(), MeshFormat::Stl);
    assert_box(text_stl().to_uppercase().replace('\n', "\r\n\t").as_bytes(), MeshFormat::Stl);
    assert_box(
        text_stl().replace("\n  outer", " outer").replace("vertex", "vertex\n").as_bytes(),
        MeshFormat::Stl,
    );
    assert_box(&binary_stl(b"exported"), MeshFormat::Stl);
    assert_box(&binary_stl(b"solid box"), MeshFormat::Stl);
    assert_box(&binary_stl(b"solid box\0"), MeshFormat::Stl);
}

/// Several solids in one file are one body; −0 is 0.
#[test]
fn stl_with_several_solids() {
    let text = text_stl();
    let middle = "endsolid one\nsolid two\n facet";
    let facets: Vec<&str> = text.splitn(8, " facet").collect();
    let split = format!("{}{middle}{}", facets[..7].join(" facet"), facets[7]);
    assert_box(split.as_bytes(), MeshFormat::Stl);
    assert_box(text.replacen("0e0", "-0", 5).as_bytes(), MeshFormat::Stl);
    let mesh = TriangleMesh::parse(text.as_bytes(), MeshFormat::Stl, "box").unwrap();
    assert_eq!(mesh.vertices().len(), 8);
}

#[test]
fn obj_dialects() {
    assert_box(obj().as_bytes(), MeshFormat::Obj);
    // With a weight, and with a colour.
    for extra in [" 1.0", " 0.5 0.5 1"] {
        let lines: Vec<String> = obj()
            .lines()
            .map(|l| if l.starts_with("v ") { format!("{l}{extra}") } else { l.into() })
            .collect();
        assert_box(lines.join("\n").as_bytes(), MeshFormat::Obj);
    }
    // Faces by positive indices may come before their vertices.
    let mut lines: Vec<String> = corners().iter().map(|[x, y, z]| format!("v {x} {y} {z}")).collect();
    for [a, b, c, d] in QUADS.map(|q| q.map(|i| i + 1)) {
        lines.insert(0, format!("f {a} {b} {c} {d}"));
    }
    assert_box(lines.join("\n").as_bytes(), MeshFormat::Obj);
}

/// Six separate faces with corners of their own: seams that coordinates close.
#[test]
fn seams_are_closed() {
    let mut text = String::new();
    for quad in QUADS {
        for [x, y, z] in quad.map(|i| corners()[i]) {
            text += &format!("v {x} {y} {z}\n");
        }
        text += "f -4 -3 -2 -1\n";
    }
    assert_box(text.as_bytes(), MeshFormat::Obj);
}

#[test]
fn ply() {
    assert_box(text_ply().as_bytes(), MeshFormat::Ply);
    assert_box(text_ply().replace('\n', "\r\n").as_bytes(), MeshFormat::Ply);
    assert_box(&binary_ply(false), MeshFormat::Ply);
    assert_box(&binary_ply(true), MeshFormat::Ply);
}

/// By extension, in upper or lower case.
#[test]
fn files() {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    for (name, bytes) in [
        ("box.stl", binary_stl(b"solid")),
        ("box.STL", text_stl().into_bytes()),
        ("box.Obj", obj().into_bytes()),
        ("box.ply", binary_ply(true)),
    ] {
        let path = folder.join(name);
        std::fs::write(&path, bytes).unwrap();
        let mesh = TriangleMesh::read(&path).unwrap();
        assert_eq!(mesh.body(Amount::Mass(1.0)), reference().body(Amount::Mass(1.0)));
    }
}

fn samples() -> Vec<(MeshFormat, Vec<u8>)> {
    vec![
        (MeshFormat::Stl, text_stl().into_bytes()),
        (MeshFormat::Stl, binary_stl(b"solid box")),
        (MeshFormat::Obj, obj().into_bytes()),
        (MeshFormat::Ply, text_ply().into_bytes()),
        (MeshFormat::Ply, binary_ply(false)),
        (MeshFormat::Ply, binary_ply(true)),
    ]
}

/// Parsing, the body and messages do not panic.
fn survive(bytes: &[u8], format: MeshFormat) {
    match TriangleMesh::parse(bytes, format, "file") {
        Ok(mesh) => drop(mesh.body(Amount::Density(1.0)).map_err(|e| e.to_string())),
        Err(e) => drop(e.to_string()),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn random_bytes_do_not_panic(bytes in prop::collection::vec(any::<u8>(), 0..400), which in 0..6_usize) {
        for format in [MeshFormat::Stl, MeshFormat::Obj, MeshFormat::Ply] {
            survive(&bytes, format);
        }
        // Behind the beginning of a valid file they get further.
        let (format, sample) = samples().swap_remove(which);
        let kept = sample.len().min(bytes.len() + 90);
        survive(&[&sample[..kept], &bytes].concat(), format);
    }

    /// Bytes replaced, cut out, repeated, and the end lost.
    #[test]
    fn mutated_files_do_not_panic(
        which in 0..6_usize,
        replaced in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
        cut in any::<(prop::sample::Index, u8, bool)>(),
        end in any::<(prop::sample::Index, bool)>(),
    ) {
        let (format, mut bytes) = samples().swap_remove(which);
        for (at, byte) in replaced {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        let from = cut.0.index(bytes.len());
        let to = bytes.len().min(from + usize::from(cut.1 % 64));
        let piece: Vec<u8> = bytes.drain(from..to).collect();
        if cut.2 {
            let twice = piece.repeat(2);
            bytes.splice(from..from, twice);
        }
        if end.1 && !bytes.is_empty() {
            bytes.truncate(end.0.index(bytes.len()));
        }
        survive(&bytes, format);
    }
}
