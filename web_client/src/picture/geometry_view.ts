// Geometry mode: renders the slices with WebGL; draws labels, axes and parallel coordinates on a canvas above.

import { type BufferGeometry, Camera, Color, ColorManagement, GLSL3, LinearSRGBColorSpace } from "three";
import { Mesh as Drawing, RawShaderMaterial, Scene, Vector3, Vector4, WebGLRenderer } from "three";

import type { Orbit, Slices, Viewport } from "@oval4d/protocol";

import { FillMesh } from "./fill_mesh";
import { Lens } from "./lens";
import { Mesh } from "./mesh";
import { drawOverlay } from "./overlay";
import { fragmentShader, vertexShader } from "./shaders";

ColorManagement.enabled = false; // colors are sRGB values, shown unchanged

export class GeometryView {
    readonly lens = new Lens();
    private readonly renderer: WebGLRenderer;
    private readonly scene = new Scene();
    private readonly camera = new Camera();
    private readonly mesh = new Mesh();
    private readonly fillMesh = new FillMesh();
    private readonly drawing: Drawing<BufferGeometry, RawShaderMaterial>;
    private readonly fillDrawing: Drawing<BufferGeometry, RawShaderMaterial>;
    private readonly uniforms = {
        light: { value: new Vector3() },
        shading: { value: new Vector4() },
        ballRadius: { value: 0 },
        barRadius: { value: 0 },
        pixels: { value: 1 },
    };
    private readonly flat = this.material(false);
    private readonly solid = this.material(true);
    private readonly pen: CanvasRenderingContext2D;
    private picture: Slices | undefined;
    private pictureOrbit: Orbit | undefined;
    private arranged: Orbit | undefined; // the orbit for which the mesh is ordered
    private readonly background = new Color();

    /** Requires WebGL 2. */
    constructor(
        canvas: HTMLCanvasElement,
        private readonly overlay: HTMLCanvasElement,
    ) {
        this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: false, stencil: false });
        this.renderer.outputColorSpace = LinearSRGBColorSpace;
        this.pen = overlay.getContext("2d")!;
        const drawings = [
            new Drawing(this.mesh.geometry, this.flat),
            new Drawing(this.fillMesh.geometry, this.material(false)),
        ] as const;
        for (const drawing of drawings) {
            drawing.frustumCulled = drawing.matrixAutoUpdate = false;
            this.scene.add(drawing);
        }
        [this.drawing, this.fillDrawing] = drawings;
        this.fillDrawing.renderOrder = 1;
        this.fillDrawing.material.depthTest = this.fillDrawing.material.depthWrite = true;
        this.scene.matrixWorldAutoUpdate = false;
        this.camera.matrixWorldAutoUpdate = false;
    }

    /**
     * The material of the mesh: if `solid`, balls and bars have depth and are antialiased by alpha to coverage;
     * otherwise everything is drawn in painter's order.
     */
    private material(solid: boolean): RawShaderMaterial {
        return new RawShaderMaterial({
            ...{ vertexShader, fragmentShader, glslVersion: GLSL3, uniforms: this.uniforms },
            ...{ transparent: !solid, alphaToCoverage: solid, depthTest: solid, depthWrite: solid },
            defines: solid ? { SOLID: 1 } : {},
            side: 2, // DoubleSide: patches may be seen from either side
        });
    }

    /** Takes over the newest slices; `orbit` is the orbit for which they were laid out. */
    take(picture: Slices, orbit: Orbit): void {
        this.picture = picture;
        this.pictureOrbit = orbit;
        const filled = this.fillMesh.fill(picture);
        this.mesh.fill(picture, !filled);
        this.fillDrawing.visible = filled;
        this.drawing.material = filled ? this.solid : this.flat;
        this.arranged = undefined;
        const { light, ball, bar } = picture.scene;
        this.uniforms.light.value.fromArray(light.direction).normalize();
        this.uniforms.shading.value.set(light.ambient, light.diffuse, light.specular, light.shininess);
        this.uniforms.ballRadius.value = picture.scene.shown.balls ? ball : bar;
        this.uniforms.barRadius.value = bar;
    }

    /** Draws the slices taken last, as seen in this orbit; `size` is in device pixels. */
    draw(orbit: Orbit, size: Viewport): void {
        if (!this.picture || !this.pictureOrbit) return;
        const { scene } = this.picture;
        if (this.overlay.width !== size.width || this.overlay.height !== size.height) {
            this.renderer.setSize(size.width, size.height, false);
            Object.assign(this.overlay, size);
        }
        this.lens.set(scene.camera, size, this.pictureOrbit, orbit);
        const { azimuth, elevation } = orbit;
        if (azimuth !== this.arranged?.azimuth || elevation !== this.arranged.elevation) {
            this.mesh.arrange(this.lens);
            this.fillMesh.arrange(this.lens);
        }
        this.arranged = orbit;
        this.uniforms.pixels.value = this.lens.pixels;
        this.camera.projectionMatrix.copy(this.lens.projection);
        this.camera.matrixWorldInverse.copy(this.lens.view);
        this.renderer.setClearColor(this.background.setHex(scene.colors.background));
        this.renderer.render(this.scene, this.camera);
        drawOverlay(this.pen, this.picture, this.lens, size);
    }

    dispose(): void {
        this.mesh.geometry.dispose();
        this.fillMesh.geometry.dispose();
        this.renderer.dispose();
    }
}
