// Geometry mode: draws slices and projection with WebGL. Draws labels, parallel coordinates and other 2-D parts on a
// second canvas on top.

import { type BufferGeometry, Camera, Color, ColorManagement, GLSL3, LinearSRGBColorSpace } from "three";
// `Drawing` is the class Mesh of three.js: a geometry with the material that draws it.
import { Mesh as Drawing, RawShaderMaterial, Scene, Vector3, Vector4, WebGLRenderer } from "three";

import type { Orbit, Slices, Viewport } from "@oval4d/protocol";

import { FilledFacesMesh } from "./fill_mesh";
import { FogPainter } from "./fog_painter";
import {
    highlightChangeBetween,
    highlightedAndPointedElements,
    type ElementCounts,
    type HighlightedElements,
} from "./highlighted_elements";
import { HitTester } from "./hit_tester";
import { recolorForWhite } from "./on_white";
import { drawOverlay } from "./overlay";
import { ProjectionMesh } from "./projection_mesh";
import { fragmentShader, vertexShader } from "./shaders";
import { SlicesMesh } from "./slices_mesh";
import { SurfacePainter } from "./surface_painter";
import { ViewCamera } from "./view_camera";

ColorManagement.enabled = false; // colors are sRGB values, shown unchanged

export class GeometryView {
    readonly viewCamera = new ViewCamera();
    private readonly renderer: WebGLRenderer;
    private readonly scene = new Scene(); // contains the drawings of the slices
    private readonly projectionScene = new Scene();
    private readonly camera = new Camera();
    private readonly slicesMesh = new SlicesMesh();
    private readonly fillMesh = new FilledFacesMesh();
    private readonly drawing: Drawing<BufferGeometry, RawShaderMaterial>;
    private readonly fillDrawing: Drawing<BufferGeometry, RawShaderMaterial>;
    private readonly uniforms = {
        light: { value: new Vector3() },
        shading: { value: new Vector4() },
        ballRadius: { value: 0 },
        barRadius: { value: 0 },
        pixels: { value: 1 },
    };
    private readonly projectionUniforms = { ...this.uniforms, ballRadius: { value: 1 }, barRadius: { value: 0 } };
    private readonly paintedMaterial = this.makeMaterial("painted");
    private readonly solidMaterial = this.makeMaterial("solid");
    private readonly projectionMesh = new ProjectionMesh();
    private readonly projectionDrawings = [
        new Drawing(this.projectionMesh.solid, this.makeMaterial("solid", this.projectionUniforms)),
        new Drawing(this.projectionMesh.translucent, this.makeMaterial("blended", this.projectionUniforms)),
    ] as const;
    private readonly surfacePainter: SurfacePainter;
    private readonly fogPainter: FogPainter;
    private readonly pen: CanvasRenderingContext2D;
    private picture: Slices | undefined;
    private pictureOrbit: Orbit | undefined;
    private counts: ElementCounts = { edges: 0, faces: 0, cells: 0 };
    private pointed: HighlightedElements | undefined;
    private highlighted: HighlightedElements | undefined;
    /**
     * The hit tester of the picture, which finds the element at a pixel. Undefined before the first picture, and valid
     * until the next picture.
     */
    hitTester: HitTester | undefined;
    private sortedOrbit: Orbit | undefined; // the orbit for which the meshes are sorted
    private readonly background = new Color();

    /** Requires WebGL 2. */
    constructor(
        canvas: HTMLCanvasElement,
        private readonly overlay: HTMLCanvasElement,
    ) {
        this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: false, stencil: false });
        this.renderer.autoClear = false;
        this.renderer.outputColorSpace = LinearSRGBColorSpace;
        this.surfacePainter = new SurfacePainter(this.renderer);
        this.fogPainter = new FogPainter(this.renderer);
        canvas.addEventListener("webglcontextrestored", () => {
            this.surfacePainter.uploadAfterContextLoss();
            this.fogPainter.uploadAfterContextLoss();
        });
        this.pen = overlay.getContext("2d")!;
        const drawings = [
            new Drawing(this.slicesMesh.geometry, this.paintedMaterial),
            new Drawing(this.fillMesh.geometry, this.makeMaterial("painted")),
        ] as const;
        const scenes = [[this.scene, drawings], [this.projectionScene, this.projectionDrawings]] as const;
        for (const [scene, contents] of scenes) {
            for (const drawing of contents) {
                drawing.frustumCulled = drawing.matrixAutoUpdate = false;
                scene.add(drawing);
            }
            scene.matrixWorldAutoUpdate = false;
        }
        [this.drawing, this.fillDrawing] = drawings;
        this.fillDrawing.renderOrder = 1;
        this.fillDrawing.material.depthTest = this.fillDrawing.material.depthWrite = true;
        this.camera.matrixWorldAutoUpdate = false;
    }

    /**
     * Makes the material of a mesh:
     * - `painted`: shapes are drawn in painter's order, without a depth test.
     * - `solid`: shapes use the depth buffer, and alpha to coverage antialiases them.
     * - `blended`: shapes are blended in painter's order. The depth buffer hides them, but they are not written to it,
     *   so they hide nothing.
     */
    private makeMaterial(kind: "painted" | "solid" | "blended", uniforms = this.uniforms): RawShaderMaterial {
        const [painted, solid] = [kind === "painted", kind === "solid"];
        return new RawShaderMaterial({
            ...{ vertexShader, fragmentShader, glslVersion: GLSL3, uniforms },
            ...{ transparent: !solid, alphaToCoverage: solid, depthTest: !painted, depthWrite: solid },
            defines: painted ? {} : { SOLID: 1 },
            side: 2, // DoubleSide: both sides of a face may be visible
        });
    }

    /**
     * Replaces the picture to draw. `orbit` is the orbit for which the server placed the picture's camera. `counts` has
     * the polytope's numbers of elements.
     */
    update(picture: Slices, orbit: Orbit, counts: ElementCounts): void {
        this.counts = counts;
        this.picture = picture;
        this.pictureOrbit = orbit;
        this.hitTester = new HitTester(picture, orbit);
        const highlighted = (this.highlighted = highlightedAndPointedElements(picture, this.pointed));
        const filled = this.fillMesh.update(picture, highlighted);
        const isField = this.surfacePainter.update(picture) || picture.scene.fog !== undefined;
        this.fogPainter.update(picture);
        this.slicesMesh.update(picture, !filled && !isField, highlighted);
        this.fillDrawing.visible = filled;
        // With the opacity 1, faces may cross each other, or the object is a surface (see protocol/README.md).
        const needsDepths = filled || isField || picture.scene.opacity === 1;
        this.drawing.material = needsDepths ? this.solidMaterial : this.paintedMaterial;
        this.sortedOrbit = undefined;
        const { light, ball, bar } = picture.scene;
        this.uniforms.light.value.fromArray(light.direction).normalize();
        this.uniforms.shading.value.set(light.ambient, light.diffuse, light.specular, light.shininess);
        this.uniforms.ballRadius.value = picture.scene.shown.balls ? ball : bar;
        this.uniforms.barRadius.value = bar;
        this.projectionMesh.update(picture, highlighted);
        this.projectionUniforms.barRadius.value = this.projectionMesh.barRadius;
    }

    /** Highlights the elements under the pointer until the next call. Does not redraw the picture. */
    highlightPointed(pointed: HighlightedElements | undefined): void {
        this.pointed = pointed;
        const { picture, highlighted: before } = this;
        if (!picture || !before) return;
        const highlighted = (this.highlighted = highlightedAndPointedElements(picture, pointed));
        const change = highlightChangeBetween(before, highlighted);
        for (const mesh of [this.slicesMesh, this.fillMesh, this.projectionMesh]) {
            mesh.writeColorsToBuffers(picture, highlighted, change);
        }
    }

    /**
     * Draws the picture as seen from this orbit. `size` and `leastText`, the least font size of labels, are in device
     * pixels.
     */
    draw(orbit: Orbit, size: Viewport, leastText: number): void {
        if (!this.picture || !this.pictureOrbit) return;
        const { scene } = this.picture;
        if (this.overlay.width !== size.width || this.overlay.height !== size.height) {
            this.renderer.setSize(size.width, size.height, false);
            Object.assign(this.overlay, size);
        }
        this.viewCamera.set(scene.camera, size, this.pictureOrbit, orbit);
        const { azimuth, elevation } = orbit;
        if (azimuth !== this.sortedOrbit?.azimuth || elevation !== this.sortedOrbit.elevation) {
            this.slicesMesh.sortForCamera(this.viewCamera);
            this.fillMesh.sortForCamera(this.viewCamera);
            if (this.picture.projection) this.projectionMesh.sortForCamera(this.viewCamera);
        }
        this.sortedOrbit = orbit;
        this.uniforms.pixels.value = this.viewCamera.pixelsPerUnit;
        this.camera.projectionMatrix.copy(this.viewCamera.projection);
        this.camera.matrixWorldInverse.copy(this.viewCamera.view);
        this.renderer.setClearColor(this.background.setHex(scene.colors.background));
        this.render();
        this.makeOpaque();
        drawOverlay(this.pen, this.picture, this.viewCamera, size, leastText, this.highlighted!, this.counts);
    }

    /**
     * Draws the picture on white with `pen`, whose canvas has the size `size`. The caller must then call draw(), which
     * shows the usual picture on the page again.
     */
    drawForPrint(pen: CanvasRenderingContext2D, orbit: Orbit, size: Viewport, leastText: number): void {
        const { picture, pictureOrbit, counts, pointed } = this;
        if (!picture || !pictureOrbit) return;
        this.pointed = undefined;
        this.update(recolorForWhite(picture), pictureOrbit, counts);
        this.draw(orbit, size, leastText);
        for (const canvas of [this.renderer.domElement, this.overlay]) pen.drawImage(canvas, 0, 0);
        this.pointed = pointed;
        this.update(picture, pictureOrbit, counts);
    }

    /**
     * Sets the alpha of all pixels to 1. Alpha to coverage leaves other values in the canvas. Firefox on Mesa uses them
     * when it composes the page, although the context has no alpha channel.
     */
    private makeOpaque(): void {
        const gl = this.renderer.getContext();
        this.renderer.state.buffers.color.setClear(0, 0, 0, 1, false);
        gl.colorMask(false, false, false, true);
        gl.clear(gl.COLOR_BUFFER_BIT);
        gl.colorMask(true, true, true, true);
    }

    /**
     * Renders the projection, then the slices. The depths of the projection are cleared in between, so that the
     * projection never covers a slice.
     */
    private render(): void {
        const { renderer, fogPainter, surfacePainter, viewCamera } = this;
        renderer.clear();
        if (this.picture!.projection) {
            surfacePainter.draw("opaque", viewCamera, "projection");
            renderer.render(this.projectionScene, this.camera);
            surfacePainter.draw("translucent", viewCamera, "projection");
            renderer.clearDepth();
        }
        if (fogPainter.hasFog) {
            fogPainter.captureOccluderDepths(this.overlay, "frame", () => renderer.render(this.scene, this.camera));
            fogPainter.captureOccluderDepths(this.overlay, "surfaces", () => surfacePainter.draw("opaque", viewCamera, "slices"));
        }
        surfacePainter.draw("opaque", viewCamera, "slices");
        if (fogPainter.hasFog) this.drawFogAndSurfaces("behind");
        renderer.render(this.scene, this.camera);
        if (fogPainter.hasFog) this.drawFogAndSurfaces("inFront");
        else surfacePainter.draw("translucent", viewCamera, "slices");
    }

    /**
     * Draws a part of the fog of each slice, from far to near (see FogPainter.draw()). Before the part "inFront" of a
     * slice, draws the slice's translucent surfaces.
     */
    private drawFogAndSurfaces(part: "behind" | "inFront"): void {
        this.fogPainter.begin(this.viewCamera);
        const depths = new Map(this.picture!.slices.map((slice) => [slice, this.viewCamera.depthOf(slice.position)]));
        for (const [slice] of [...depths].sort(([, a], [, b]) => b - a)) {
            if (part === "inFront") this.surfacePainter.draw("translucent", this.viewCamera, slice);
            this.fogPainter.draw(slice, this.viewCamera, part);
        }
    }

    dispose(): void {
        this.slicesMesh.geometry.dispose();
        this.fillMesh.geometry.dispose();
        this.projectionMesh.dispose();
        this.surfacePainter.dispose();
        this.fogPainter.dispose();
        this.renderer.dispose();
    }
}
