import { Color, Group, LineBasicMaterial, LineSegments, Mesh, MeshLambertMaterial } from "three";
import type { Surface } from "../core/core.ts";
import type { Shown } from "../document.ts";
import type { Palette } from "../palette.ts";
import type { Figure } from "./figure.ts";
import type { Instant, Part } from "./part.ts";
import { type Look, look } from "./surface.ts";

/** Tints of faces, as in `Surface`: two of alternating quadrants, and one for the sides across each axis. */
const TINTS = 5;

/** The body, tinted so that its rotation is visible. */
export class Body implements Part {
  readonly inBody = new Group();
  private readonly materials = Array.from({ length: TINTS }, () => new MeshLambertMaterial());
  private readonly ink = inkOfEdges();
  private drawn: { surface: Surface; look: Look } | null = null;

  follow({ surface }: Figure): void {
    if (this.drawn && same(this.drawn.surface, surface)) return;
    this.clear();
    const fresh = look(surface);
    this.drawn = { surface, look: fresh };
    this.inBody.add(new Mesh(fresh.faces, this.materials), new LineSegments(fresh.edges, this.ink));
  }

  paint(palette: Palette): void {
    const mixed = (color: string, part: number) => new Color(palette.body).lerp(new Color(color), part);
    const colors = [
      mixed(palette.body, 0),
      mixed(palette.weight, 0.4),
      ...palette.axes.map((axis) => mixed(axis, 0.22)),
    ];
    this.materials.forEach((material, k) => material.color.copy(colors[k]!));
    this.ink.color.set(palette.text);
  }

  update(_: Instant, shown: Shown): void {
    this.inBody.visible = shown.body;
    for (const material of this.materials) {
      // Transparent with Poinsot's construction, which is inside and behind it.
      if (material.transparent === shown.poinsot) continue;
      material.transparent = shown.poinsot;
      material.opacity = shown.poinsot ? 0.55 : 1;
      material.needsUpdate = true;
    }
  }

  dispose(): void {
    this.clear();
    for (const material of this.materials) material.dispose();
    this.ink.dispose();
  }

  private clear(): void {
    this.inBody.clear();
    this.drawn?.look.faces.dispose();
    this.drawn?.look.edges.dispose();
    this.drawn = null;
  }
}

/** Edges lie in faces: they are drawn slightly nearer, at the same place in the picture. */
function inkOfEdges(): LineBasicMaterial {
  const ink = new LineBasicMaterial({ transparent: true, opacity: 0.55 });
  ink.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader.replace(
      "#include <project_vertex>",
      "#include <project_vertex>\n gl_Position = projectionMatrix * vec4(mvPosition.xyz * 0.999, 1.0);",
    );
  };
  return ink;
}

/** While a slider moves, motions follow each other fast, mostly of the same body. */
function same(a: Surface, b: Surface): boolean {
  return equal(a.vertices, b.vertices) && equal(a.faces, b.faces) && equal(a.tints, b.tints);
}

function equal(a: Float64Array | Uint32Array, b: Float64Array | Uint32Array): boolean {
  return a.length === b.length && a.every((x: number, k: number) => x === b[k]);
}
