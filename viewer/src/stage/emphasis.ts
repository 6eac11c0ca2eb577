import { type Material, Mesh, type Object3D, ShaderMaterial } from "three";
import type { Shown } from "../document.ts";

/** Factors of opacity and width: of what is pointed at, and of everything else. */
const STRONG = { face: 2.6, width: 1.7 };
const PALE = 0.22;

/** Says which layer objects belong to, so that they can be emphasized together. */
export function ofLayer<T extends Object3D>(layer: keyof Shown, object: T): T {
  object.userData["layer"] = layer;
  return object;
}

/** Emphasizes a layer against the others; null shows all as they are. Solid surfaces stay solid. */
export function emphasize(root: Object3D, layer: keyof Shown | null): void {
  const visit = (object: Object3D, inherited: unknown): void => {
    const own = object.userData["layer"] ?? inherited;
    if (object instanceof Mesh)
      for (const material of [object.material].flat()) weigh(material, layer === null ? null : own === layer);
    for (const child of object.children) visit(child, own);
  };
  visit(root, null);
}

function weigh(material: Material, hit: boolean | null): void {
  const opaque = !material.transparent && material.userData["opacity"] === undefined;
  if (opaque && !(material instanceof ShaderMaterial)) return;
  if (material instanceof ShaderMaterial) {
    const { opacity, weight } = material.uniforms;
    if (!opacity || !weight) return;
    const base: number = (material.userData["opacity"] ??= opacity.value);
    opacity.value = base * (hit === false ? PALE : 1);
    weight.value = hit === true ? STRONG.width : 1;
    return;
  }
  const base: number = (material.userData["opacity"] ??= material.opacity);
  material.opacity = hit === null ? base : hit ? Math.min(STRONG.face * base, 1) : PALE * base;
}
