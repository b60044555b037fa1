// Draws the surfaces of a field with a depth buffer, like server/render/slices/surface_batch.cpp. Opaque surfaces are
// drawn first; translucent surfaces are blended over the picture later. The arrays of a picture are uploaded without
// conversion. Each slice has its own range of the buffers, and the vertex shader moves the slice to its places in the
// picture. The painter shares the WebGL context with three.js, and tells three.js when it has changed the context's
// state.

import type { WebGLRenderer } from "three";

import type { Slice, Slices, Surface, SurfaceLevel, Vector } from "@oval4d/protocol";

import { makeProgram } from "./shader_program";
import { TrianglesByLevel } from "./triangles_by_level";
import type { ViewCamera } from "./view_camera";

const kLight = `
uniform vec3 light;
uniform vec4 shading;  // ambient, diffuse, specular, shininess
vec3 lit(vec3 color, vec3 n) {
    vec3 h = normalize(light + vec3(0.0, 0.0, 1.0));
    float specular = shading.z * pow(max(dot(n, h), 0.0), shading.w);
    return min(color * (shading.x + shading.y * max(dot(n, light), 0.0)) + specular, 1.0);
}
`;

const kVertexShader = `#version 300 es
precision highp float;
layout(location = 0) in vec3 point;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 pointColor;  // blue, green, red, 0
uniform mat4 view, projection;
uniform vec4 place;  // xyz: the world position of the slice's origin; w: world units per unit of the object
uniform vec4 color;  // not premultiplied by alpha
uniform bool hasPointColors;
out vec3 seen, tint, material;
${kLight}
void main() {
    seen = (view * vec4(place.xyz + place.w * point, 1.0)).xyz;
    gl_Position = projection * vec4(seen, 1.0);
    vec3 n = normalize(mat3(view) * normal);
    if (dot(n, seen) > 0.0) n = -n;
    material = hasPointColors ? pointColor.bgr : color.rgb;
    tint = color.a * lit(material, n);
}
`;

const kFragmentShader = `#version 300 es
precision highp float;
in vec3 seen, tint, material;
uniform vec4 color;
uniform bool isCap;  // caps are flat
out vec4 pixel;
${kLight}
void main() {
    vec3 flatTint = color.a * lit(material, normalize(cross(dFdx(seen), dFdy(seen))));
    pixel = vec4(isCap ? flatTint : tint, color.a);
}
`;

const kUniforms = ["view", "projection", "place", "color", "hasPointColors", "isCap", "light", "shading"] as const;

/**
 * The buffers for the attributes 0 (points), 1 (normals) and 2 (colors or capColors), and for the indices (triangles).
 */
const kBuffers = ["points", "normals", "colors", "capColors", "triangles"] as const;
type SurfaceBufferName = (typeof kBuffers)[number];

/** The WebGL objects of the painter. The browser may lose them together with their context. */
interface SurfaceResources {
    program: WebGLProgram;
    uniforms: Record<(typeof kUniforms)[number], WebGLUniformLocation | null>;
    arrays: WebGLVertexArrayObject;
    buffers: Record<SurfaceBufferName, { buffer: WebGLBuffer; size: number }>;
}

/** The surfaces of one slice, and their place in the buffers. */
interface SliceSurfaces {
    slice: Slice;
    surface: Surface;
    groups: TrianglesByLevel;
    firstPoint: number;
    firstByte: number; // the offset of the slice's indices in the buffer, in bytes
}

/** A place where the surfaces of a slice are drawn: at the slice, or in the projection of the whole object. */
interface PlacedSurfaces {
    part: SliceSurfaces;
    position: Vector;
    scale: number; // world units per unit of the object
    isInProjection: boolean;
    depth: number; // the distance of `position` from the eye, along the view axis
}

export class SurfacePainter {
    private readonly parts: SliceSurfaces[] = [];
    private readonly spare: SliceSurfaces[] = [];
    private readonly placed: PlacedSurfaces[] = []; // from far to near after the sorting in draw()
    private picture: Slices | undefined; // the newest picture; undefined if it has no surfaces
    private levels: SurfaceLevel[] = []; // from the innermost to the outermost
    private resources: SurfaceResources | undefined; // created at the first use
    private readonly gl: WebGL2RenderingContext;

    constructor(private readonly renderer: WebGLRenderer) {
        this.gl = renderer.getContext() as WebGL2RenderingContext;
    }

    /** Uploads the surfaces of a new picture to the GPU. Returns whether the picture shows surfaces of a field. */
    update(picture: Slices): boolean {
        this.spare.push(...this.parts.splice(0));
        this.placed.length = 0;
        this.levels = picture.scene.surfaces ?? [];
        this.picture = undefined;
        const { projection, scene } = picture;
        for (const slice of picture.slices) {
            const { surface, drawn, position, focus } = slice;
            if (!surface || !drawn) continue;
            const part = this.spare.pop() ?? emptySliceSurfaces(slice, surface);
            Object.assign(part, { slice, surface });
            part.groups.update(surface);
            this.parts.push(part);
            this.placed.push({ part, position, scale: scene.scale, isInProjection: false, depth: 0 });
            if (focus && projection?.surface_scale !== undefined) {
                const place = { position: projection.position, scale: projection.surface_scale };
                this.placed.push({ part, ...place, isInProjection: true, depth: 0 });
            }
        }
        if (this.parts.length > 0) {
            this.picture = picture;
            this.upload();
        }
        return picture.scene.surfaces !== undefined;
    }

    /** Uploads everything again, after the context has been lost and restored. */
    uploadAfterContextLoss(): void {
        this.resources = undefined;
        if (this.picture) this.upload();
    }

    dispose(): void {
        if (!this.resources) return;
        const { program, arrays, buffers } = this.resources;
        this.gl.deleteProgram(program);
        this.gl.deleteVertexArray(arrays);
        for (const { buffer } of Object.values(buffers)) this.gl.deleteBuffer(buffer);
        this.resources = undefined;
    }

    private upload(): void {
        const { gl, parts } = this;
        if (gl.isContextLost()) return;
        const { arrays } = (this.resources ??= makeResources(gl));
        let [points, bytes] = [0, 0];
        for (const part of parts) {
            part.firstPoint = points;
            part.firstByte = bytes;
            points += part.surface.points.length / 3;
            bytes += Math.ceil(part.groups.triangles.byteLength / 4) * 4; // 32-bit indices must begin at multiples of 4
        }
        gl.bindVertexArray(arrays);
        this.bindAndReserve("points", 12 * points);
        for (const { surface, firstPoint } of parts) gl.bufferSubData(gl.ARRAY_BUFFER, 12 * firstPoint, surface.points);
        this.bindAndReserve("normals", 12 * points);
        for (const { surface, firstPoint } of parts) gl.bufferSubData(gl.ARRAY_BUFFER, 12 * firstPoint, surface.normals);
        this.bindAndReserve("colors", this.hasPointColors(false) ? 4 * points : 0);
        for (const { surface, firstPoint } of parts) {
            if (surface.colors) gl.bufferSubData(gl.ARRAY_BUFFER, 4 * firstPoint, surface.colors);
        }
        this.bindAndReserve("capColors", this.hasPointColors(true) ? 4 * points : 0);
        for (const { surface, firstPoint } of parts) {
            if (surface.cap_colors) gl.bufferSubData(gl.ARRAY_BUFFER, 4 * firstPoint, surface.cap_colors);
        }
        this.bindAndReserve("triangles", bytes);
        for (const { groups, firstByte } of parts) {
            gl.bufferSubData(gl.ELEMENT_ARRAY_BUFFER, firstByte, groups.triangles);
        }
        gl.bindVertexArray(null);
        this.renderer.resetState();
    }

    /** Whether the points of level surfaces (`isCap` false) or of caps (`isCap` true) have their own colors. */
    private hasPointColors(isCap: boolean): boolean {
        const surface = this.parts[0]?.surface;
        return (isCap ? surface?.cap_colors : surface?.colors) !== undefined;
    }

    /** Binds a buffer, and enlarges it if it has fewer than `bytes` bytes. Enlarging discards the contents. */
    private bindAndReserve(name: SurfaceBufferName, bytes: number): void {
        const { gl } = this;
        const target = name === "triangles" ? gl.ELEMENT_ARRAY_BUFFER : gl.ARRAY_BUFFER;
        const entry = this.resources!.buffers[name];
        gl.bindBuffer(target, entry.buffer);
        if (bytes <= entry.size) return;
        entry.size = 2 ** Math.ceil(Math.log2(bytes));
        gl.bufferData(target, entry.size, gl.DYNAMIC_DRAW);
    }

    /**
     * Draws the opaque surfaces, or the translucent surfaces from far to near. `of` chooses whose surfaces are drawn:
     * all slices, one slice, or the focus slice in the projection.
     */
    draw(which: "opaque" | "translucent", viewCamera: ViewCamera, of: Slice | "slices" | "projection"): void {
        const { gl, picture, placed } = this;
        const opaque = which === "opaque";
        if (!picture || !this.resources || !this.levels.some((level) => isOpaque(level) === opaque)) return;
        const { program, uniforms, arrays } = this.resources;
        const { light } = picture.scene;
        for (const one of placed) one.depth = viewCamera.depthOf(one.position);
        placed.sort((a, b) => b.depth - a.depth);
        gl.useProgram(program);
        gl.bindVertexArray(arrays);
        gl.uniformMatrix4fv(uniforms.view, false, viewCamera.view.elements);
        gl.uniformMatrix4fv(uniforms.projection, false, viewCamera.projection.elements);
        const [x, y, z] = light.direction;
        const length = Math.hypot(x, y, z);
        gl.uniform3f(uniforms.light, x / length, y / length, z / length);
        gl.uniform4f(uniforms.shading, light.ambient, light.diffuse, light.specular, light.shininess);
        gl.enable(gl.DEPTH_TEST);
        gl.depthFunc(gl.LESS);
        gl.depthMask(opaque);
        if (opaque) gl.disable(gl.BLEND);
        else gl.enable(gl.BLEND);
        gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
        gl.disable(gl.SAMPLE_ALPHA_TO_COVERAGE);
        // Opaque surfaces need no order, but drawing is faster if nearer ones come first.
        for (let i = 0; i < placed.length; ++i) {
            const one = placed[opaque ? placed.length - 1 - i : i]!;
            if (one.isInProjection !== (of === "projection")) continue;
            if (typeof of === "string" || one.part.slice === of) this.drawSlice(one, opaque);
        }
        gl.bindVertexArray(null);
        this.renderer.resetState();
    }

    private drawSlice({ part, position, scale }: PlacedSurfaces, opaque: boolean): void {
        const { gl } = this;
        const { uniforms, buffers } = this.resources!;
        const { firstPoint } = part;
        gl.uniform4f(uniforms.place, ...position, scale);
        gl.bindBuffer(gl.ARRAY_BUFFER, buffers.points.buffer);
        gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 12 * firstPoint);
        gl.bindBuffer(gl.ARRAY_BUFFER, buffers.normals.buffer);
        gl.vertexAttribPointer(1, 3, gl.FLOAT, false, 0, 12 * firstPoint);
        for (const level of this.levels) {
            if (isOpaque(level) === opaque) this.drawLevel(part, level);
        }
    }

    private drawLevel(part: SliceSurfaces, level: SurfaceLevel): void {
        const { gl } = this;
        const { uniforms } = this.resources!;
        const color = part.surface.color ?? level.color;
        gl.uniform4f(uniforms.color, (color >> 16) / 255, ((color >> 8) & 255) / 255, (color & 255) / 255, level.opacity);
        if (!isOpaque(level)) {
            for (const hidden of [gl.FRONT, gl.BACK]) this.drawLevelTriangles(part, level, hidden);
        } else if (level.caps) {
            this.drawLevelTriangles(part, level, gl.BACK); // a surface with caps is closed, so its back is invisible
        } else {
            this.drawLevelTriangles(part, level, undefined);
        }
    }

    /**
     * Draws the triangles of a level. `hidden` is the side that is not drawn, gl.FRONT or gl.BACK; undefined draws both
     * sides.
     */
    private drawLevelTriangles(
        { groups, firstByte, firstPoint }: SliceSurfaces,
        { level, caps }: SurfaceLevel,
        hidden: GLenum | undefined,
    ): void {
        const { gl } = this;
        const { uniforms } = this.resources!;
        if (hidden === undefined) {
            gl.disable(gl.CULL_FACE);
        } else {
            gl.enable(gl.CULL_FACE);
            gl.cullFace(hidden);
        }
        const size = groups.triangles.BYTES_PER_ELEMENT;
        const type = size === 4 ? gl.UNSIGNED_INT : size === 2 ? gl.UNSIGNED_SHORT : gl.UNSIGNED_BYTE;
        for (const isCap of [false, true]) {
            const [begin, end] = groups.range(level, Number(isCap));
            if (begin === end || (isCap && !caps)) continue;
            gl.uniform1i(uniforms.isCap, Number(isCap));
            this.selectColors(isCap, firstPoint);
            gl.drawElements(gl.TRIANGLES, 3 * (end - begin), type, firstByte + 3 * begin * size);
        }
    }

    /**
     * Selects the colors for the triangles that are drawn next. These are the colors of the points of level surfaces
     * or, if `isCap` is true, of caps. If these points have no colors, selects the color of the level.
     */
    private selectColors(isCap: boolean, firstPoint: number): void {
        const { gl } = this;
        const { uniforms, buffers } = this.resources!;
        gl.uniform1i(uniforms.hasPointColors, Number(this.hasPointColors(isCap)));
        if (this.hasPointColors(isCap)) {
            gl.enableVertexAttribArray(2);
            gl.bindBuffer(gl.ARRAY_BUFFER, (isCap ? buffers.capColors : buffers.colors).buffer);
            gl.vertexAttribPointer(2, 4, gl.UNSIGNED_BYTE, true, 0, 4 * firstPoint);
        } else {
            gl.disableVertexAttribArray(2);
        }
    }
}

function isOpaque({ opacity }: SurfaceLevel): boolean {
    return opacity === 1;
}

function emptySliceSurfaces(slice: Slice, surface: Surface): SliceSurfaces {
    return { slice, surface, groups: new TrianglesByLevel(), firstPoint: 0, firstByte: 0 };
}

function makeResources(gl: WebGL2RenderingContext): SurfaceResources {
    const { program, uniforms } = makeProgram(gl, "surfaces", kVertexShader, kFragmentShader, kUniforms);
    const arrays = gl.createVertexArray();
    gl.bindVertexArray(arrays);
    gl.enableVertexAttribArray(0);
    gl.enableVertexAttribArray(1);
    gl.bindVertexArray(null);
    const buffers = Object.fromEntries(kBuffers.map((name) => [name, { buffer: gl.createBuffer(), size: 0 }]));
    return { program, uniforms, arrays, buffers } as SurfaceResources;
}
