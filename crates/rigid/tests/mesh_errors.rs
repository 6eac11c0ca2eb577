//! Error messages of meshes and mesh files.

use polhode_ga::Vector;
use polhode_rigid::body::mesh::MeshFormat;
use polhode_rigid::{Amount, TriangleMesh};
use std::path::PathBuf;

const OCTAHEDRON: [[u32; 3]; 8] =
    [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];

fn octahedron() -> Vec<Vector> {
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vector);
    // Adding 0 turns −0 into 0, which reads better in the messages.
    axes.iter().flat_map(|&e| [e, -e]).map(|v| v + Vector::default()).collect()
}

fn parse(text: impl AsRef<[u8]>, format: MeshFormat) -> String {
    TriangleMesh::parse(text.as_ref(), format, "rock").unwrap_err().to_string()
}

fn obj(text: &str) -> String {
    parse(text, MeshFormat::Obj)
}

fn stl(text: impl AsRef<[u8]>) -> String {
    parse(text, MeshFormat::Stl)
}

fn ply(text: impl AsRef<[u8]>) -> String {
    parse(text, MeshFormat::Ply)
}

/// The message of the body of these triangles.
fn body(vertices: Vec<Vector>, faces: Vec<[u32; 3]>) -> String {
    let mesh = TriangleMesh::new(vertices, faces).unwrap();
    mesh.body(Amount::Density(1.0)).unwrap_err().to_string()
}

#[test]
fn files_that_cannot_be_read() {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    let read = |name: &str| TriangleMesh::read(&folder.join(name)).unwrap_err().to_string();
    let prefix = folder.display().to_string();

    let missing = read("missing.stl");
    assert!(missing.starts_with(&format!("{prefix}/missing.stl: cannot be read: ")), "{missing}");
    assert!(missing.ends_with("; check the path"), "{missing}");

    std::fs::create_dir_all(folder.join("folder.obj")).unwrap();
    assert!(read("folder.obj").ends_with("cannot be read: it is not a regular file; check the path"));

    std::fs::write(folder.join("empty.ply"), "").unwrap();
    assert!(read("empty.ply").ends_with("empty.ply: the file is empty; export the mesh again"));

    assert!(
        read("rock.gltf").ends_with("unknown extension 'gltf', expected stl, obj or ply; convert the mesh")
    );
    assert!(read("rock").contains("no extension, expected stl, obj or ply"));
}

#[test]
fn empty_and_without_triangles() {
    let none = "rock: the mesh has no triangles; a body needs a closed surface";
    for format in [MeshFormat::Stl, MeshFormat::Obj, MeshFormat::Ply] {
        assert_eq!(parse("", format), "rock: the file is empty; export the mesh again");
    }
    assert_eq!(obj("# nothing\nv 0 0 0\n"), none);
    assert_eq!(stl("solid\nendsolid\n"), none);
    assert_eq!(stl([0; 84]), none);
    assert_eq!(ply("ply\nformat ascii 1.0\nend_header\n"), none);
    assert_eq!(body(octahedron(), vec![]), none.replace("rock", "mesh"));
}

#[test]
fn corrupt_obj() {
    let end = "; correct it or export the mesh again";
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let face = |f: &str| obj(&format!("{vertices}{f}\n"));
    assert_eq!(obj("v 0 0 0\nv 1 zero 0\n"), format!("rock: line 2: 'zero' is not a number{end}"));
    assert_eq!(
        obj("# made by hand\nsolid rock\nendsolid\n"),
        format!(
            "rock: line 2: 'solid' begins neither a vertex, `v x y z`, nor a face, `f 1 2 3`, and no line does{end}"
        )
    );
    assert_eq!(obj("v 0 0 0 red\n"), format!("rock: line 1: 'red' is not a number{end}"));
    // Lines may end in a carriage return alone.
    assert_eq!(obj("v 0 0 0\rv 1 zero 0\r"), format!("rock: line 2: 'zero' is not a number{end}"));
    assert_eq!(obj("v 0 \\\n 0\n"), format!("rock: line 1: a vertex needs 3 coordinates, got 2{end}"));
    assert_eq!(face("f 1 2"), format!("rock: line 4: a face needs at least 3 corners, got 2{end}"));
    let no = |i: i64| {
        format!("rock: line 4: vertex {i} does not exist: there are 3 vertices, numbered from 1{end}")
    };
    assert_eq!(face("f 1 2 4"), no(4));
    assert_eq!(face("f 1 0 2"), no(0));
    assert_eq!(face("f -1 -2 -4"), no(-4));
    assert_eq!(face("f 1 2 9223372036854775807"), no(i64::MAX));
    assert_eq!(face("f 1 2 -9223372036854775808"), no(i64::MIN));
    for corner in ["a", "1/b", "1/2/3/4", "1.5", "/1", "99999999999999999999"] {
        assert_eq!(
            face(&format!("f 1 2 {corner}")),
            format!("rock: line 4: '{corner}' is not a corner of a face, such as 7, 7/1, 7//1 or 7/1/1{end}")
        );
    }
    // What is quoted is shortened, and need not be text.
    let long = obj(&format!("v 0 0 {}\n", "x".repeat(1000)));
    assert_eq!(long, format!("rock: line 1: '{}…' is not a number{end}", "x".repeat(40)));
    assert!(parse(b"v 0 0 \xff\xfe\n", MeshFormat::Obj).contains("'\u{fffd}\u{fffd}' is not a number"));
}

#[test]
fn coordinates_that_are_not_finite() {
    let end = "is not finite; correct its coordinates";
    assert_eq!(
        obj("v 0 0 0\nv 0 nan 1\n"),
        format!("rock: line 2: vertex 1 (counted from 0) at (0.0, NaN, 1.0) {end}")
    );
    assert_eq!(
        obj("v 1e400 0 0\n"),
        format!("rock: line 1: vertex 0 (counted from 0) at (inf, 0.0, 0.0) {end}")
    );
    assert_eq!(
        stl("solid\nfacet normal nan nan nan\nouter loop\nvertex 0 0 0\nvertex 0 -inf 0\n"),
        format!("rock: line 5: vertex 1 (counted from 0) at (0.0, -inf, 0.0) {end}")
    );
    let mut binary = vec![0; 84 + 50];
    binary[80] = 1;
    binary[84 + 12 + 12..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
    assert_eq!(stl(binary), format!("rock: byte 108: vertex 1 (counted from 0) at (NaN, 0.0, 0.0) {end}"));
    let header =
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n";
    assert_eq!(
        ply(format!("{header}end_header\n1 2 3\n1 2 inf\n")),
        format!("rock: line 9: vertex 1 (counted from 0) at (1.0, 2.0, inf) {end}")
    );
    let mut vertices = octahedron();
    vertices[3].0[2] = f64::NAN;
    assert_eq!(
        TriangleMesh::new(vertices, OCTAHEDRON.to_vec()).unwrap_err().to_string(),
        format!("mesh: vertex 3 (counted from 0) at (0.0, -1.0, NaN) {end}")
    );
}

#[test]
fn indices_and_factors_of_meshes_in_memory() {
    assert_eq!(
        TriangleMesh::new(octahedron(), vec![[0, 1, 2], [0, 6, 1]]).unwrap_err().to_string(),
        "mesh: triangle 1 (counted from 0) refers to vertex 6, but there are 6 vertices, counted from 0; correct the index"
    );
    let mesh = TriangleMesh::new(octahedron(), OCTAHEDRON.to_vec()).unwrap();
    for factor in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(
            mesh.scaled(factor).unwrap_err().to_string(),
            format!("mesh: scale must be positive and finite, got {factor:?}")
        );
    }
    for factor in [1e-60, 1e60] {
        let message = mesh.scaled(factor).unwrap().body(Amount::Mass(1.0)).unwrap_err().to_string();
        assert!(message.starts_with("mesh: the mesh extends over 3.46410161513775"), "{message}");
        assert!(
            message.ends_with(" m, outside the supported range of 1e-50 to 1e50 m; check the unit"),
            "{message}"
        );
    }
    let twice = mesh.scaled(1e200).unwrap().scaled(1e200).unwrap_err().to_string();
    assert_eq!(
        twice,
        "mesh: vertex 0 (counted from 0) at (inf, 0.0, 0.0) is not finite; correct its coordinates"
    );
}

#[test]
fn corrupt_and_truncated_stl() {
    let correct = "; correct it or export the mesh again";
    let copy = "; copy or export it again";
    assert_eq!(
        stl("not an STL"),
        format!(
            "rock: byte 10: the file is truncated, neither a text STL nor long enough for the 84-byte header of a binary one{copy}"
        )
    );
    // Four billion triangles are claimed, none is there: nothing is allocated for them.
    let mut claimed = vec![0; 80];
    claimed.extend([0xff; 4]);
    assert_eq!(
        stl(&claimed),
        format!(
            "rock: byte 84: the file is truncated, 4294967295 triangles need 214748364834 bytes, but there are 84{copy}"
        )
    );
    let mut solid = b"solid rock".to_vec();
    solid.resize(84 + 150, 0);
    solid[80] = 4;
    assert_eq!(
        stl(&solid),
        format!("rock: byte 234: the file is truncated, 4 triangles need 284 bytes, but there are 234{copy}")
    );
    solid[80] = 2;
    assert_eq!(
        stl(&solid),
        format!(
            "rock: byte 80: wrong number of triangles: 2 triangles need 184 bytes, but there are 234{correct}"
        )
    );
    let stands = |line: usize, found: &str, wanted: &str| {
        format!("rock: line {line}: expected {wanted}, got '{found}'{correct}")
    };
    assert_eq!(stl("solid a\nfacets\n"), stands(2, "facets", "'facet' or 'endsolid'"));
    assert_eq!(stl("solid a\nendsolid a\nfacet\n"), stands(3, "facet", "'solid'"));
    assert_eq!(stl("solid a\nfacet\nvertex"), stands(3, "vertex", "'normal'"));
    let facet = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n";
    assert_eq!(stl(format!("{facet}vertex 1 1 0\n")), stands(7, "vertex", "'endloop'"));
    assert_eq!(stl(facet.replace("1 0 0", "1 O 0")), format!("rock: line 5: 'O' is not a number{correct}"));
    let ends = |line: usize, wanted: &str| {
        format!("rock: line {line}: the file is truncated, expected {wanted}{copy}")
    };
    assert_eq!(stl("solid a\nfacet normal 0 0"), ends(2, "a normal"));
    assert_eq!(stl("solid a\nfacet normal 0 0 1 outer loop vertex 1 2"), ends(2, "a coordinate"));
    assert_eq!(stl(facet.trim_end()), ends(6, "'endloop'"));
    assert_eq!(stl(format!("{facet}endloop endfacet")), ends(7, "'endsolid'"));
    let text = format!("{facet}endloop\nendfacet\nendsolid\n");
    let zero = format!("rock: byte {}: a zero byte in a text STL{correct}", text.len());
    assert_eq!(stl(format!("{text}\0")), zero);
}

#[test]
fn corrupt_and_truncated_ply() {
    let correct = "; correct it or export the mesh again";
    let copy = "; copy or export it again";
    let at = |line: usize, what: &str| format!("rock: line {line}: {what}{correct}");
    let ascii = "ply\nformat ascii 1.0\n";
    assert_eq!(ply("plyx\n"), at(1, "expected 'ply', got 'plyx'"));
    assert_eq!(
        ply("ply\nformat ascii 1.0\n"),
        format!("rock: byte 21: the file is truncated, the header's 'end_header' is missing{copy}")
    );
    assert_eq!(
        ply("ply\nformat binary 1.0\n"),
        at(2, "unknown format 'binary', expected one of ascii, binary_little_endian, binary_big_endian")
    );
    assert_eq!(ply("ply\nend_header\n"), at(2, "the header has no line 'format'"));
    assert_eq!(
        ply(format!("{ascii}element vertex many\n")),
        at(3, "'many' is not a number of rows (0 to 4294967295)")
    );
    assert_eq!(ply(format!("{ascii}property float x\n")), at(3, "a property before the first element"));
    assert_eq!(
        ply(format!("{ascii}element vertex 1\nproperty real x\n")),
        at(4, "'real' is not a number type")
    );
    assert_eq!(
        ply(format!("{ascii}element face 1\nproperty list float int vertex_indices\n")),
        at(4, "a list cannot be counted by 'float'")
    );
    assert_eq!(
        ply(format!("{ascii}element face 1\nproperty int\n")),
        at(4, "expected 'property TYPE NAME' or 'property list TYPE TYPE NAME'")
    );
    assert_eq!(ply(format!("{ascii}colour red\n")), at(3, "'colour red' is not a header line"));
    assert_eq!(
        ply(format!("{ascii}element vertex 1\nproperty float x\nproperty float z\nend_header\n")),
        at(6, "the vertices have no property 'y'")
    );
    assert_eq!(
        ply(format!("{ascii}element face 1\nproperty int vertex_indices\nend_header\n")),
        at(5, "the faces have no list property 'vertex_indices'")
    );

    let declared = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                    element face 1\nproperty list char int vertex_indices\nend_header\n";
    let text = |rows: &str| ply(format!("{ascii}{declared}{rows}"));
    let vertices = "0 0 0\n1 0 0\n0 1 0\n";
    assert_eq!(text("0 0 0\n1 0\n"), at(11, "the row has fewer numbers than the element has properties"));
    assert_eq!(text("0 0 0\n1 0 0 0\n"), at(11, "the row has more numbers than the element has properties"));
    assert_eq!(text("0 0 0\n1 0 x\n"), at(11, "'x' is not a number"));
    assert_eq!(text(&format!("{vertices}-3 0 1 2\n")), at(13, "invalid list length -3.0"));
    assert_eq!(text(&format!("{vertices}2 0 1\n")), at(13, "a face needs at least 3 corners, got 2"));
    for index in ["3", "-1", "0.5", "NaN", "4294967296"] {
        assert_eq!(
            text(&format!("{vertices}3 0 1 {index}\n")),
            at(13, &format!("vertex {index} does not exist: there are 3 vertices, numbered from 0"))
        );
    }
    assert_eq!(
        text("0 0 0\n\n"),
        format!(
            "rock: line 10: the file is truncated, row 1 (counted from 0) of 3 of the element 'vertex' is missing{copy}"
        )
    );

    // Four billion rows are claimed.
    let claimed =
        format!("ply\nformat binary_little_endian 1.0\n{declared}").replace("vertex 3", "vertex 4294967295");
    let length = claimed.len();
    assert_eq!(
        ply(claimed),
        format!(
            "rock: byte {length}: the file is truncated, row 0 (counted from 0) of 4294967295 of the element 'vertex' is missing{copy}"
        )
    );
}

#[test]
fn degenerate_triangles() {
    let mut faces = OCTAHEDRON.to_vec();
    faces.insert(3, [0, 2, 2]);
    faces.push([1, 1, 1]);
    assert_eq!(
        body(octahedron(), faces),
        "mesh: 2 degenerate triangles, the first is triangle 3 (counted from 0) with corners (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 1.0, 0.0), which has no area; remove them"
    );
    // In a line that no coordinates are exactly on.
    let third = 1.0 / 3.0;
    let mut vertices = octahedron();
    vertices.extend([[0.1, 0.7, third], [0.2, 1.4, 2.0 * third], [0.4, 2.8, 4.0 * third]].map(Vector));
    let mut faces = OCTAHEDRON.to_vec();
    faces.push([6, 7, 8]);
    let message = body(vertices, faces);
    assert!(message.contains("1 degenerate triangle, the first is triangle 8"), "{message}");
    assert!(message.ends_with("remove it"), "{message}");
}

#[test]
fn repeated_triangles() {
    let mut faces = OCTAHEDRON.to_vec();
    let [a, b, c] = faces[2];
    faces.push([b, c, a]);
    faces.extend(OCTAHEDRON);
    let message = body(octahedron(), faces);
    let start = "mesh: 9 repeated triangles, the first is triangle 8 (counted from 0), a copy of triangle 2";
    assert!(message.starts_with(start), "{message}");
}

#[test]
fn byte_order_marks_and_other_texts() {
    let with_mark = b"\xef\xbb\xbfv 0 0 0\nv 1 zero 0\n";
    let error = TriangleMesh::parse(with_mark, MeshFormat::Obj, "rock").unwrap_err().to_string();
    assert!(error.starts_with("rock: line 2: 'zero'"), "{error}");
    let page = "<!DOCTYPE html>\n".repeat(20);
    let error = TriangleMesh::parse(page.as_bytes(), MeshFormat::Stl, "rock").unwrap_err().to_string();
    assert!(error.contains("not an STL file"), "{error}");
}

#[test]
fn open_meshes() {
    let mut faces = OCTAHEDRON.to_vec();
    faces.remove(5);
    assert_eq!(
        body(octahedron(), faces),
        "mesh: the mesh is open: 3 edges of one triangle only, \
         the first from (0.0, 1.0, 0.0) to (-1.0, 0.0, 0.0) of triangle 1 (counted from 0); close the holes"
    );
    let flat = body(octahedron(), vec![[0, 2, 4]]);
    assert!(flat.contains("is open: 3 edges"), "{flat}");
}

#[test]
fn inconsistent_winding() {
    let mut faces = OCTAHEDRON.to_vec();
    faces[5].swap(0, 1);
    assert_eq!(
        body(octahedron(), faces),
        "mesh: the winding is inconsistent: 3 edges traversed twice in the same direction, \
         the first from (0.0, 1.0, 0.0) to (-1.0, 0.0, 0.0) of triangle 1 (counted from 0) and of triangle 5; \
         reorient the faces, counterclockwise seen from outside"
    );
}

/// A wall across the middle: its four edges have three triangles, two of them the same way.
#[test]
fn unbalanced_edges() {
    let mut faces = OCTAHEDRON.to_vec();
    faces.extend([[0, 2, 1], [0, 1, 3]]);
    assert_eq!(
        body(octahedron(), faces),
        "mesh: the mesh is not a closed surface: 4 edges of three or more triangles traversed unequally often in the two directions, \
         the first from (1.0, 0.0, 0.0) to (0.0, 1.0, 0.0) of triangle 0 (counted from 0), 2 times in this direction and 1 times in the other; \
         remove the extra faces or reorient them"
    );
}

#[test]
fn nothing_inside() {
    // A triangle and its back.
    let message = body(octahedron(), vec![[0, 2, 4], [0, 4, 2]]);
    assert!(message.starts_with("mesh: the enclosed volume is zero to rounding ("), "{message}");
    assert!(message.ends_with(" m³); the mesh must enclose a volume"), "{message}");
}

#[test]
fn inside_out() {
    let faces = OCTAHEDRON.map(|[a, b, c]| [a, c, b]).to_vec();
    assert_eq!(
        body(octahedron(), faces),
        "mesh: the mesh is inside-out: its winding is consistent but the volume is -1.3333333333333333 m³; \
         reverse the faces, counterclockwise seen from outside"
    );
}

#[test]
fn impossible_amounts() {
    let mesh = TriangleMesh::new(octahedron(), OCTAHEDRON.to_vec()).unwrap();
    let error = |amount| mesh.body(amount).unwrap_err().to_string();
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(
            error(Amount::Mass(bad)),
            format!("mesh: mass must be positive and finite, got {bad:?} kg")
        );
        assert_eq!(
            error(Amount::Density(bad)),
            format!("mesh: density must be positive and finite, got {bad:?} kg/m³")
        );
    }
}

/// A distant cavity that subtracts more than the body has.
#[test]
fn impossible_moments() {
    let shifted = |v: &Vector| *v * 0.9 + Vector([5.0, 0.0, 0.0]);
    let mut vertices = octahedron();
    vertices.extend(octahedron().iter().map(shifted));
    let mut faces = OCTAHEDRON.to_vec();
    faces.extend(OCTAHEDRON.map(|[a, b, c]| [a + 6, c + 6, b + 6]));
    let message = body(vertices, faces);
    assert!(message.starts_with("mesh: no body has the moments "), "{message}");
    assert!(message.contains("inside-out or parts overlap"), "{message}");
}
