import { Color, Group, LineBasicMaterial, LineSegments, Mesh, MeshLambertMaterial } from "three";
import type { Part, Setting } from "./part.ts";
import { look } from "./surface.ts";

/** The body, tinted so that its rotation is visible. */
export function body({ figure, palette }: Setting): Part {
  const { faces, edges } = look(figure.surface);
  const mixed = (color: string, part: number) => new Color(palette.body).lerp(new Color(color), part);
  const axes = palette.axes.map((axis) => mixed(axis, 0.22));
  // Two of alternating quadrants, and one for the sides across each axis.
  const tints = [mixed(palette.body, 0), mixed(palette.weight, 0.4), ...axes];
  const materials = tints.map((color) => new MeshLambertMaterial({ color }));
  const inBody = new Group().add(new Mesh(faces, materials), new LineSegments(edges, ink(palette.text)));
  return {
    layer: "body",
    inBody,
    update(_, shown) {
      inBody.visible = shown.body;
      for (const material of materials) {
        // Transparent with Poinsot's construction, which is inside and behind it.
        if (material.transparent === shown.poinsot) continue;
        material.transparent = shown.poinsot;
        material.opacity = shown.poinsot ? 0.55 : 1;
        material.needsUpdate = true;
      }
    },
  };
}

/** Edges lie in faces: they are drawn slightly nearer, at the same place in the picture. */
function ink(color: string): LineBasicMaterial {
  const material = new LineBasicMaterial({ color, transparent: true, opacity: 0.55 });
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader.replace(
      "#include <project_vertex>",
      "#include <project_vertex>\n gl_Position = projectionMatrix * vec4(mvPosition.xyz * 0.999, 1.0);",
    );
  };
  return material;
}
