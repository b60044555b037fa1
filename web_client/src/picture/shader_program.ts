// Shader programs for painters that use WebGL directly, without three.js.

/**
 * Compiles and links a program, and looks up its uniforms `names`. On failure, throws an Error whose message contains
 * `of`, a name for the program.
 */
export function makeProgram<Name extends string>(
    gl: WebGL2RenderingContext,
    of: string,
    vertexShader: string,
    fragmentShader: string,
    names: readonly Name[],
): { program: WebGLProgram; uniforms: Record<Name, WebGLUniformLocation | null> } {
    const program = gl.createProgram();
    for (const [type, source] of [
        [gl.VERTEX_SHADER, vertexShader],
        [gl.FRAGMENT_SHADER, fragmentShader],
    ] as const) {
        const shader = gl.createShader(type)!;
        gl.shaderSource(shader, source);
        gl.compileShader(shader);
        gl.attachShader(program, shader);
        gl.deleteShader(shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
        throw new Error(`the shaders of ${of}: ${gl.getProgramInfoLog(program)}`);
    }
    const uniforms = Object.fromEntries(names.map((name) => [name, gl.getUniformLocation(program, name)]));
    return { program, uniforms: uniforms as Record<Name, WebGLUniformLocation | null> };
}
