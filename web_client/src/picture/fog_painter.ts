// Draws the fog of a field over the picture by ray casting, like server/render/slices/fog_painter.cpp. Shares the WebGL
// context with three.js, and tells three.js when it has changed the state of the context.

import { DepthTexture, WebGLRenderTarget, type WebGLRenderer } from "three";

import type { Fog, Slice, Slices, Viewport } from "@oval4d/protocol";

import { makeProgram } from "./shader_program";
import type { ViewCamera } from "./view_camera";

const kVertexShader = `#version 300 es
precision highp float;
layout(location = 0) in vec3 corner;  // 0 or 1 along each axis of the box
uniform mat4 view, projection;
uniform vec4 origin;  // the world position of the slice's origin, and the circumradius in world units
uniform vec3 low, size;
uniform float latticeStep;
out vec3 place;
out float depthSeen;
void main() {
    place = low + latticeStep * (size - 1.0) * corner;
    gl_Position = projection * (view * vec4(origin.xyz + origin.w * place, 1.0));
    gl_Position.z = 0.0;
    depthSeen = gl_Position.w;
}
`;

const kFragmentShader = `#version 300 es
precision highp float;
precision highp sampler3D;
// Lengths in the slice are in circumradii: squares of lengths in object units could overflow or underflow.
in vec3 place;
in float depthSeen;  // the distance of place from the eye along the view axis
uniform sampler3D lattice;   // red: the value of a lattice point, 0 if there is none; green: 1 if there is a value
uniform sampler3D blocks;    // per block of 4 × 4 × 4 lattice cells: 0 if the block contains no fog
uniform sampler2D table;     // per value: the color of fog, and its absorption per circumradius
uniform sampler2D frameDepths, surfaceDepths;
uniform vec2 toDepth;        // (a, b): the depth of a point at the distance d is a + b / d, from -1 to 1
uniform bool isBehind;       // true: draws the fog behind balls and bars; false: the fog in front of them
uniform vec3 eye;            // the eye in slice coordinates; walls and low are also in slice coordinates
uniform vec4 walls[8];
uniform int wallCount;
uniform vec3 low;            // the lattice point with the least x, y and z
uniform vec3 size;           // the numbers of lattice points along x, y and z
uniform float latticeStep;
out vec4 pixel;
// Returns the distance along the view axis of the nearest shape at this pixel of the texture; 1e30 if there is none.
float distanceIn(sampler2D depths) {
    float depth = texelFetch(depths, ivec2(gl_FragCoord.xy), 0).r;
    return depth < 1.0 ? toDepth.y / (2.0 * depth - 1.0 - toDepth.x) : 1e30;
}
void main() {
    // The ray is eye + t * way. Its part in the fog is from t = begin to t = end.
    vec3 way = place - eye;
    way += vec3(equal(way, vec3(0.0))) * 1e-20;
    vec3 first = (low - eye) / way, last = (low + latticeStep * (size - 1.0) - eye) / way;
    vec3 near = min(first, last), far = max(first, last);
    float begin = max(max(near.x, near.y), max(near.z, 0.0)), end = min(far.x, min(far.y, far.z));
    for (int i = 0; i < wallCount; ++i) {
        float along = dot(walls[i].xyz, way), room = walls[i].w - dot(walls[i].xyz, eye);
        if (along > 0.0) end = min(end, room / along);
        else if (along < 0.0) begin = max(begin, room / along);
        else if (room < 0.0) discard;
    }
    float surface = distanceIn(surfaceDepths), frame = min(surface, distanceIn(frameDepths));
    if (isBehind) begin = max(begin, frame / depthSeen);
    end = min(end, (isBehind ? surface : frame) / depthSeen);
    if (!(begin < end)) discard;
    float reach = (end - begin) * length(way);
    float count = clamp(ceil(reach / latticeStep), 1.0, 512.0);
    float thickness = reach / count;
    vec3 move = (end - begin) / count * way / (latticeStep * size);
    vec3 at = ((eye + begin * way - low) / latticeStep + 0.5) / size + 0.5 * move;
    vec3 light = vec3(0.0);
    float clear = 1.0;
    for (float i = 0.0; i < count && clear > 0.002; ++i, at += move) {
        vec3 block = clamp((at * size - 0.5) / 4.0, vec3(0.0), (size - 1.001) / 4.0);
        if (texelFetch(blocks, ivec3(block), 0).r == 0.0) {
            // This block contains no fog. Leaps to the last sample in the block; the next sample is in another block.
            vec3 perStep = move * size / 4.0;
            vec3 steps = (floor(block) + vec3(greaterThan(perStep, vec3(0.0))) - block) / perStep;
            float leap = max(ceil(min(steps.x, min(steps.y, steps.z))) - 1.0, 0.0);
            i += leap;
            at += leap * move;
            continue;
        }
        vec2 texel = textureLod(lattice, at, 0.0).rg;
        if (texel.g == 0.0) continue;
        vec4 look = texelFetch(table, ivec2(int(texel.r / texel.g * 255.0 + 0.5), 0), 0);
        float through = exp(-look.a * thickness * texel.g);
        light += clear * (1.0 - through) * look.rgb;
        clear *= through;
    }
    pixel = vec4(light, 1.0 - clear);
}
`;

const kUniforms = [
    ...(["view", "projection", "origin", "lattice", "blocks", "table", "frameDepths", "surfaceDepths"] as const),
    ...(["toDepth", "isBehind", "eye", "walls", "wallCount", "low", "size", "latticeStep"] as const),
] as const;

const kSamplers = ["lattice", "blocks", "table", "frameDepths", "surfaceDepths"] as const;

const kBlock = 4; // the number of lattice cells along each side of a block
// The least fraction of light that a layer of fog lets through if it is as thick as the circumradius. This also limits
// opaque fog (alpha 255), so that its absorption stays finite.
const kClearest = 1e-4;
/**
 * The coordinates x, y, z of the 8 corners of the unit box. Bits 0, 1 and 2 of a corner's number are its x, y and z.
 */
const kCorners = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((i) => [i & 1, (i >> 1) & 1, i >> 2]);
/** The 12 triangles of the unit box. Each has three corner numbers, counterclockwise as seen from outside. */
const kTriangles = [
    ...[0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4],
    ...[2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6],
];

/** The WebGL objects of the painter. The browser may lose them together with their context. */
interface FogResources {
    program: WebGLProgram;
    uniforms: Record<(typeof kUniforms)[number], WebGLUniformLocation | null>;
    arrays: WebGLVertexArrayObject;
    buffers: WebGLBuffer[];
    table: WebGLTexture;
    lattices: Map<Slice, { values: WebGLTexture; blocks: WebGLTexture }>;
}

/**
 * The kinds of shapes that can hide fog. "frame" means balls and bars, whose antialiased edges let fog shine through;
 * "surfaces" means surfaces of fields.
 */
type FogOccluders = "frame" | "surfaces";

export class FogPainter {
    private picture: Slices | undefined; // the newest picture; undefined if it has no fog
    private resources: FogResources | undefined; // created when they are needed
    // Framebuffers with the depths of each kind of occluder; created at the first use.
    private targets: Record<FogOccluders, WebGLRenderTarget> | undefined;
    private readonly gl: WebGL2RenderingContext;

    constructor(private readonly renderer: WebGLRenderer) {
        this.gl = renderer.getContext() as WebGL2RenderingContext;
    }

    /** Uploads the fog of a new picture to the GPU. If the picture has no fog, frees the GPU memory. */
    update(picture: Slices): void {
        const hadFog = this.picture !== undefined;
        this.picture = picture.scene.fog && picture;
        if (this.picture) this.upload();
        else if (hadFog) this.dispose();
    }

    /** Whether the picture has fog. */
    get hasFog(): boolean {
        return this.picture !== undefined;
    }

    /** Uploads all data to the GPU again. Must be called after the WebGL context was lost and restored. */
    uploadAfterContextLoss(): void {
        this.resources = undefined;
        if (this.picture) this.upload();
    }

    dispose(): void {
        for (const target of Object.values(this.targets ?? {})) target.dispose();
        this.targets = undefined;
        if (!this.resources) return;
        const { program, arrays, buffers, table, lattices } = this.resources;
        this.gl.deleteProgram(program);
        this.gl.deleteVertexArray(arrays);
        for (const buffer of buffers) this.gl.deleteBuffer(buffer);
        this.gl.deleteTexture(table);
        for (const each of lattices.values()) for (const texture of Object.values(each)) this.gl.deleteTexture(texture);
        this.resources = undefined;
    }

    private upload(): void {
        const { gl } = this;
        if (gl.isContextLost()) return;
        const resources = (this.resources ??= makeFogResources(gl));
        for (const each of resources.lattices.values()) {
            for (const texture of Object.values(each)) gl.deleteTexture(texture);
        }
        resources.lattices.clear();
        gl.bindBuffer(gl.PIXEL_UNPACK_BUFFER, null);
        gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
        gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, false);
        gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, false);
        gl.activeTexture(gl.TEXTURE0);
        gl.bindTexture(gl.TEXTURE_2D, resources.table);
        const { table } = this.picture!.scene.fog!;
        const looks = colorTexelsOf(table);
        gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, looks.length / 4, 1, 0, gl.RGBA, gl.FLOAT, looks);
        for (const slice of this.picture!.slices) {
            if (!slice.fog || !slice.drawn) continue;
            const values = makeTexture(gl, gl.TEXTURE_3D, gl.LINEAR);
            const [x, y, z] = slice.fog.size;
            gl.texImage3D(gl.TEXTURE_3D, 0, gl.RG8, x, y, z, 0, gl.RG, gl.UNSIGNED_BYTE, valueTexelsOf(slice.fog));
            const blocks = makeTexture(gl, gl.TEXTURE_3D, gl.NEAREST);
            const [[u, v, w], texels] = blockVisibilityOf(slice.fog, table);
            gl.texImage3D(gl.TEXTURE_3D, 0, gl.R8, u, v, w, 0, gl.RED, gl.UNSIGNED_BYTE, texels);
            resources.lattices.set(slice, { values, blocks });
        }
        this.renderer.resetState();
    }

    /**
     * Stores the depths of all occluders of one kind in a framebuffer of this size, for a later call of draw(). `draw`
     * must draw all occluders of this kind, and nothing else.
     */
    captureOccluderDepths({ width, height }: Viewport, occluders: FogOccluders, draw: () => void): void {
        this.targets ??= { frame: makeDepthReadableTarget(4), surfaces: makeDepthReadableTarget(0) };
        const target = this.targets[occluders];
        target.setSize(width, height);
        this.renderer.setRenderTarget(target);
        this.renderer.clear();
        draw();
        this.renderer.setRenderTarget(null);
    }

    /** Prepares for draw(). Must be called after captureOccluderDepths() for both kinds of occluders. */
    begin(viewCamera: ViewCamera): void {
        const { gl, picture, resources } = this;
        if (!picture || !resources) return;
        const { program, uniforms } = resources;
        gl.useProgram(program);
        gl.uniformMatrix4fv(uniforms.view, false, viewCamera.view.elements);
        gl.uniformMatrix4fv(uniforms.projection, false, viewCamera.projection.elements);
        // A point at distance d along the view axis has the depth −P₂₂ + P₂₃ / d. P is the projection matrix, with
        // indices from 0.
        gl.uniform2f(uniforms.toDepth, -viewCamera.projection.elements[10]!, viewCamera.projection.elements[14]!);
        kSamplers.forEach((name, unit) => gl.uniform1i(uniforms[name], unit));
    }

    /**
     * Blends a part of the fog of one slice with the picture. `behind` is the fog behind the nearest ball or bar; the
     * caller must draw it before the balls and bars, so that it shines through their edges. `inFront` is the rest of
     * the fog. The caller must draw the slices from far to near.
     */
    draw(slice: Slice, viewCamera: ViewCamera, part: "behind" | "inFront"): void {
        const { gl, picture, resources, targets } = this;
        const lattice = resources?.lattices.get(slice);
        if (!picture || !resources || !targets || !lattice || !slice.fog) return;
        const { program, uniforms, arrays, table } = resources;
        const { size, min, step, walls } = slice.fog;
        const { circumradius } = picture.scene;
        const scale = picture.scene.scale * circumradius;
        const { x, y, z } = viewCamera.eye;
        const [atX, atY, atZ] = slice.position;
        gl.useProgram(program);
        gl.uniform1i(uniforms.isBehind, Number(part === "behind"));
        gl.uniform4f(uniforms.origin, atX, atY, atZ, scale);
        gl.uniform3f(uniforms.eye, (x - atX) / scale, (y - atY) / scale, (z - atZ) / scale);
        gl.uniform1i(uniforms.wallCount, walls.length / 4);
        const scaled = walls.map((value, i) => (i % 4 === 3 ? value / circumradius : value));
        if (walls.length > 0) gl.uniform4fv(uniforms.walls, scaled);
        gl.uniform3f(uniforms.low, min[0] / circumradius, min[1] / circumradius, min[2] / circumradius);
        gl.uniform3f(uniforms.size, ...size);
        gl.uniform1f(uniforms.latticeStep, step / circumradius);
        const depthsOf = (target: WebGLRenderTarget): WebGLTexture =>
            (this.renderer.properties.get(target.depthTexture!) as { __webglTexture: WebGLTexture }).__webglTexture;
        const textures = [
            [gl.TEXTURE_3D, lattice.values],
            [gl.TEXTURE_3D, lattice.blocks],
            [gl.TEXTURE_2D, table],
            [gl.TEXTURE_2D, depthsOf(targets.frame)],
            [gl.TEXTURE_2D, depthsOf(targets.surfaces)],
        ] as const;
        textures.forEach(([target, texture], unit) => {
            gl.activeTexture(gl.TEXTURE0 + unit);
            gl.bindTexture(target, texture);
        });
        gl.bindVertexArray(arrays);
        gl.disable(gl.DEPTH_TEST);
        gl.depthMask(false);
        gl.enable(gl.BLEND);
        gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
        gl.disable(gl.SAMPLE_ALPHA_TO_COVERAGE);
        gl.enable(gl.CULL_FACE); // draws only the back of the box, which is visible even from inside the box
        gl.cullFace(gl.FRONT);
        gl.drawElements(gl.TRIANGLES, kTriangles.length, gl.UNSIGNED_BYTE, 0);
        gl.bindVertexArray(null);
        this.renderer.resetState();
    }
}

/**
 * Makes a framebuffer whose depths can be read. `samples` is the number of samples per pixel; 0 means no multisampling.
 * Balls and bars need multisampling, because alpha to coverage antialiases them.
 */
function makeDepthReadableTarget(samples: number): WebGLRenderTarget {
    return new WebGLRenderTarget(1, 1, { samples, stencilBuffer: false, depthTexture: new DepthTexture(1, 1) });
}

/**
 * The texels of the fog's color table, one for each value. The four channels are red, green and blue from 0 to 1, and
 * the absorption coefficient a per circumradius. A layer of d circumradii lets through exp(−a·d) of the light. `table`
 * has colors 0xAARRGGBB, where AA / 255 is the opacity of a layer that is one circumradius thick.
 */
function colorTexelsOf(table: ArrayLike<number>): Float32Array {
    const looks = new Float32Array(4 * table.length);
    for (let i = 0; i < table.length; ++i) {
        const entry = table[i]!;
        for (const [channel, shift] of [16, 8, 0].entries()) looks[4 * i + channel] = ((entry >>> shift) & 255) / 255;
        looks[4 * i + 3] = -Math.log(Math.max(1 - (entry >>> 24) / 255, kClearest));
    }
    return looks;
}

/** Two bytes for each lattice point: its value and 255. Both bytes are 0 where the field has no value. */
function valueTexelsOf({ values }: Fog): Uint8Array {
    const texels = new Uint8Array(2 * values.length);
    for (let i = 0; i < values.length; ++i) {
        texels[2 * i] = values[i]!;
        texels[2 * i + 1] = values[i]! > 0 ? 255 : 0;
    }
    return texels;
}

/**
 * Finds which blocks of the lattice may show fog. Returns the number of blocks along each axis, and a byte for each
 * block: 255 if fog may be visible in it, 0 if not. Fog may be visible if any value between the least and the greatest
 * value in the block is not transparent.
 */
function blockVisibilityOf({ size, values }: Fog, table: ArrayLike<number>): [[number, number, number], Uint8Array] {
    const [x, y, z] = size;
    const [u, v, w] = size.map((points) => Math.max(Math.ceil((points - 1) / kBlock), 1)) as [number, number, number];
    // Entry v is the number of values below v that are not transparent.
    const visibleBelow = new Uint16Array(table.length + 1);
    for (let i = 0; i < table.length; ++i) visibleBelow[i + 1] = visibleBelow[i]! + (table[i]! >>> 24 ? 1 : 0);
    const texels = new Uint8Array(u * v * w);
    for (let at = 0; at < texels.length; ++at) {
        const first = [at % u, Math.floor(at / u) % v, Math.floor(at / (u * v))].map((block) => block * kBlock);
        let least = 255;
        let greatest = 0;
        for (let k = first[2]!; k <= Math.min(first[2]! + kBlock, z - 1); ++k) {
            for (let j = first[1]!; j <= Math.min(first[1]! + kBlock, y - 1); ++j) {
                for (let i = first[0]!; i <= Math.min(first[0]! + kBlock, x - 1); ++i) {
                    const value = values[(k * y + j) * x + i]!;
                    if (value === 0) continue; // a point without a value
                    least = Math.min(least, value);
                    greatest = Math.max(greatest, value);
                }
            }
        }
        texels[at] = greatest > 0 && visibleBelow[greatest + 1]! > visibleBelow[least]! ? 255 : 0;
    }
    return [[u, v, w], texels];
}

function makeTexture(gl: WebGL2RenderingContext, target: GLenum, filter: GLenum): WebGLTexture {
    const texture = gl.createTexture();
    gl.bindTexture(target, texture);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(target, name, filter);
    for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R]) {
        gl.texParameteri(target, name, gl.CLAMP_TO_EDGE);
    }
    return texture;
}

function makeFogResources(gl: WebGL2RenderingContext): FogResources {
    const { program, uniforms } = makeProgram(gl, "fog", kVertexShader, kFragmentShader, kUniforms);
    const arrays = gl.createVertexArray();
    const buffers = [gl.createBuffer(), gl.createBuffer()] as const;
    gl.bindVertexArray(arrays);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffers[0]);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(kCorners), gl.STATIC_DRAW);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffers[1]);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint8Array(kTriangles), gl.STATIC_DRAW);
    gl.bindVertexArray(null);
    const table = makeTexture(gl, gl.TEXTURE_2D, gl.NEAREST);
    return { program, uniforms, arrays, buffers: [...buffers], table, lattices: new Map() };
}
