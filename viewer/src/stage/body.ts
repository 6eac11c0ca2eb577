import { Color, Group, LineBasicMaterial, LineSegments, Mesh, MeshLambertMaterial } from "three";
import type { Shown } from "../document.ts";
import type { Palette } from "../palette.ts";
import type { Figure } from "./figure.ts";
import type { Instant, Part } from "./part.ts";
import { type Look, look, type Surface } from "./surface.ts";

/** Tints of faces: plain, alternate quadrants, and the sides perpendicular to axes 1, 2 and 3. */
const TINTS = 5;

/** The body. Sides of boxes and quadrants of round solids have different tints, so that their rotation is visible. */
export class Body implements Part {
  readonly inBody = new Group();
  private readonly materials = Array.from({ length: TINTS }, () => new MeshLambertMaterial());
  private readonly ink = inkOfEdges();
  private drawn: { surface: Surface; tinted: Figure["tinted"]; look: Look } | null = null;

  follow({ surface, tinted }: Figure): void {
    const drawn = this.drawn;
    if (drawn?.tinted === tinted && same(drawn.surface, surface)) return;
    this.clear();
    const fresh = look(surface, tinted === "plain" ? undefined : tinted === "sides" ? side : quadrant);
    this.drawn = { surface, tinted, look: fresh };
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

function side(normal: readonly number[]): number {
  const sizes = normal.map(Math.abs);
  return 2 + sizes.indexOf(Math.max(...sizes));
}

function quadrant(_: readonly number[], [x, y]: readonly number[]): number {
  return x! * y! > 0 ? 1 : 0;
}

/** While a slider moves, motions change often, and mostly have the same surface. */
function same(a: Surface, b: Surface): boolean {
  return (
    a.vertices.length === b.vertices.length &&
    a.faces.length === b.faces.length &&
    every(a.vertices, b.vertices) &&
    every(a.faces, b.faces)
  );
}

function every(a: ArrayLike<number>, b: ArrayLike<number>): boolean {
  for (let k = 0; k < a.length; k++) if (a[k] !== b[k]) return false;
  return true;
}
