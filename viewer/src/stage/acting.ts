import { CylinderGeometry, Group, Mesh, MeshLambertMaterial, Vector3 } from "three";
import { type Acting, hasMass } from "../core/core.ts";
import { quantity } from "../format/numbers.ts";
import type { Label } from "./labels.ts";
import type { Part, Setting } from "./part.ts";
import { AXES, vector } from "./rotor.ts";
import { circle, HEAD, Shapes } from "./shapes.ts";

type Source = Acting["sources"][number];

/** Letters and words at what is drawn. */
const SYMBOLS: Record<Source["kind"], string> = {
  planet: "to the planet",
  field: "B",
  dipole: "m",
  sun: "to the sun",
  wheel: "wheel",
};
/** Where the arrow of a direction begins and ends, and how far those of a dipole and of a thrust reach. */
const AWAY = [1.05, 1.7] as const;
const SHORT = 0.8;
/** Lines of a field: their distance from the middle, and half their length. */
const FIELD = { away: 0.95, half: 1.25 };
const WHEEL = { radius: 0.4, half: 0.05, axis: 0.62 };

/** A drawing along e3 of its group, with its label at a place there. */
interface Glyph {
  group: Group;
  label: Label;
  tip: Vector3;
}

/**
 * What the laws depend on, where it acts: lines along a field, arrows to the planet and to the sun, a dipole of the body,
 * wheels as discs on their axes, and thrusts at their points. Null if there is none of these.
 */
export function acting(setting: Setting): Part | null {
  const { figure, palette, labels } = setting;
  const start = figure.acting;
  if (!start || start.sources.length + start.thrusts.length === 0) return null;
  const [inSpace, inBody] = [new Group(), new Group()];
  const glyph = (symbol: string, drawn: Group, tip: number, away = 0): Glyph => {
    const label = labels.add(symbol, palette.weight, { rank: 3 });
    return { group: drawn, label, tip: new Vector3(away, 0, tip) };
  };
  const sources = start.sources.map((source) => {
    const drawn = GLYPHS[source.kind](setting, (group, tip, away) =>
      glyph(SYMBOLS[source.kind], group, tip, away),
    );
    const valued = source.kind !== "wheel" || hasMass(figure.about);
    if (source.unit && valued) drawn.label.value = quantity(vector(source.along).length(), source.unit);
    (source.in_space ? inSpace : inBody).add(drawn.group);
    return drawn;
  });
  const thrusts = start.thrusts.map(({ along }) => {
    const shapes = new Shapes(setting.screen, palette.weight);
    shapes.arrow(AXES[2].clone().multiplyScalar(SHORT), { width: 2.6, behind: 0.4 });
    shapes.object.position.z = -SHORT;
    const drawn = glyph("F", new Group().add(shapes.object), -SHORT);
    drawn.label.value = quantity(vector(along).length(), "N");
    inBody.add(drawn.group);
    return drawn;
  });
  const show = ({ group, label, tip }: Glyph, along: Vector3): void => {
    group.quaternion.setFromUnitVectors(AXES[2], along.normalize());
    label.at.copy(tip).applyQuaternion(group.quaternion).add(group.position);
  };
  const origin = figure.about.held ? new Vector3() : vector(figure.about.body.center_of_mass);
  return {
    layer: "sources",
    inSpace,
    inBody,
    update({ attitude, acting: found }, shown) {
      const seen = shown.sources && found !== null;
      inSpace.visible = inBody.visible = seen;
      for (const { label } of [...sources, ...thrusts]) label.hidden = !seen;
      if (!found || !seen) return;
      sources.forEach((drawn, k) => {
        show(drawn, vector(found.sources[k]!.along));
        if (!found.sources[k]!.in_space) drawn.label.at.applyQuaternion(attitude);
      });
      thrusts.forEach((drawn, k) => {
        const { along, at } = found.thrusts[k]!;
        drawn.group.position.copy(vector(at).sub(origin).divideScalar(figure.size));
        show(drawn, vector(along));
        drawn.label.at.applyQuaternion(attitude);
      });
    },
  };
}

type Draw = (setting: Setting, glyph: (drawn: Group, tip: number, away?: number) => Glyph) => Glyph;

/** An arrow outside the body, towards something far away. */
const towards: Draw = ({ screen, palette }, glyph) => {
  const shapes = new Shapes(screen, palette.weight);
  shapes.arrow(AXES[2].clone().multiplyScalar(AWAY[1] - AWAY[0]), { width: 2.4, behind: 0.35 });
  shapes.object.position.z = AWAY[0];
  return glyph(new Group().add(shapes.object), AWAY[1]);
};

const GLYPHS: Record<Source["kind"], Draw> = {
  planet: towards,
  sun: towards,
  dipole: ({ screen, palette }, glyph) => {
    const shapes = new Shapes(screen, palette.weight);
    shapes.arrow(AXES[2].clone().multiplyScalar(SHORT), { width: 2.6, behind: 0.4 });
    return glyph(new Group().add(shapes.object), SHORT);
  },
  field: ({ screen, palette }, glyph) => {
    const group = new Group();
    for (let k = 0; k < 6; k++) {
      const line = new Shapes(screen, palette.weight);
      line.arrow(new Vector3(0, 0, 2 * FIELD.half), { width: 1.4, opacity: 0.75, behind: 0.4 });
      line.object.position.set(FIELD.away, 0, -FIELD.half).applyAxisAngle(AXES[2], (Math.PI * k) / 3);
      group.add(line.object);
    }
    return glyph(group, FIELD.half, FIELD.away);
  },
  wheel: ({ screen, palette }, glyph) => {
    const { radius, half, axis } = WHEEL;
    const shapes = new Shapes(screen, palette.weight);
    // Inside the body: seen through it.
    for (const z of [-half, half]) {
      const rim = shapes.line(circle(AXES[2], radius), { width: 2.2, behind: 0.75 }, true);
      rim.object.position.z = z;
    }
    shapes.face(circle(AXES[2], radius), 0.25, 3);
    shapes.line([new Vector3(0, 0, -axis), new Vector3(0, 0, axis)], { width: 1.8, behind: 0.75 });
    // The sense in which it turns.
    shapes.head(new Vector3(radius, -0.5 * HEAD, half), AXES[1]);
    shapes.head(new Vector3(-radius, 0.5 * HEAD, half), AXES[1].clone().negate());
    const solid = new CylinderGeometry(radius, radius, 2 * half, 48).rotateX(Math.PI / 2);
    const group = new Group().add(shapes.object);
    group.add(new Mesh(solid, new MeshLambertMaterial({ color: palette.weight })));
    return glyph(group, axis);
  },
};
