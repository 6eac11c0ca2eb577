import { Color, ConeGeometry, Group, Mesh, MeshLambertMaterial, Vector3 } from "three";
import { AXES } from "./rotor.ts";
import { Ribbon, type RibbonStyle, type Screen } from "./ribbon.ts";

const HEAD = { length: 0.1, radius: 0.028 };

/** An arrow from the origin of its object: a line of constant width in pixels, with a cone at its end. */
export class Arrow {
  readonly object = new Group();
  private readonly shaft: Ribbon;
  private readonly head: Mesh<ConeGeometry, MeshLambertMaterial>;

  constructor(screen: Screen, style: RibbonStyle) {
    this.shaft = new Ribbon(screen, style);
    this.head = new Mesh(
      new ConeGeometry(HEAD.radius, HEAD.length, 12).translate(0, -HEAD.length / 2, 0).rotateX(Math.PI / 2),
      new MeshLambertMaterial({ emissiveIntensity: 0.45 }),
    );
    this.object.add(this.shaft.object, this.head);
  }

  /** Sets the arrow to a vector of the object. */
  point(along: Vector3): void {
    const length = along.length();
    this.object.visible = length > HEAD.length;
    if (!this.object.visible) return;
    const end = along.clone().multiplyScalar(1 - HEAD.length / length);
    this.shaft.set([0, 0, 0, end.x, end.y, end.z]);
    this.head.position.copy(along);
    this.head.quaternion.setFromUnitVectors(AXES[2], along.clone().divideScalar(length));
  }

  paint(color: string | Color): void {
    this.shaft.paint(color);
    this.head.material.color.set(color);
    this.head.material.emissive.set(color);
  }

  dispose(): void {
    this.shaft.dispose();
    this.head.geometry.dispose();
    this.head.material.dispose();
  }
}
