// Shaders that draw balls, bars and faces as flat patches with coordinates (u, v). A patch has axes X, Y and Z; the
// normal of the drawn body at (u, v) is X·u + Y·v + Z·√(1 − u² − v²). The patch of a ball is the unit disk, with Z
// toward the eye. On a bar, u runs across the bar; v is 0 except at the bar's far end, which is round. On a face, u = v
// = 0. Directions of light are passed as dot products with X, Y and Z. Edges are antialiased over one pixel. A ball or
// bar thinner than kThinnest is drawn with this radius and less opacity.

/** The kinds of patches, as values of the third component of the attribute `shape`. */
export const kBall = 0;
export const kBar = 1;
export const kFace = 2;

export const vertexShader = `
precision highp float;
uniform mat4 viewMatrix, projectionMatrix;
uniform vec3 light;
uniform vec4 shading;  // ambient, diffuse, specular, shininess
uniform float ballRadius, barRadius, pixels;
in vec3 at, to;  // a ball's center and relative radius (to.x); a bar's ends; a face's corner and normal
in vec4 shape;   // -1 or 1 across; -1 or 1 along; the kind of patch; a bar's radius in percent of barRadius
in vec4 color;
out vec3 place;  // u, v, and half the radius in pixels
flat out vec3 diffuse, specular, tint;
flat out float alpha;
flat out float leastV;  // lower limit for v in the fragment shader
#ifdef SOLID
out float depth;        // z of the patch in camera coordinates
flat out float bulge;   // how far the body rises above the patch toward the viewer
#endif

const float kThinnest = 0.6;      // the least radius, in pixels
const float kMinFootRadius = 1.8;  // radius in pixels; thinner bars have no foot

// Widens a radius, in pixels, to at least kThinnest. Returns the factor by which the radius grows. Sets alpha to the
// opacity that makes up for it, and place.z to half the new radius.
float widen(float radius, bool round) {
    float part = min(radius / kThinnest, 1.0);
    alpha = round ? part * part : part;
    place.z = 0.5 * max(radius, kThinnest);
    return 1.0 / part;
}

void ball(vec3 center, float radius, vec3 h) {
    float d2 = dot(center, center), inside2 = d2 - radius * radius;
    if (center.z > -radius || inside2 <= 0.0) return;
    float wide = widen(radius * pixels / -center.z, true), reach = sqrt(1.0 + 0.5 / place.z);
    vec3 z = -center / sqrt(d2), x = normalize(vec3(z.z, 0.0, -z.x)), y = cross(z, x);
    place.xy = shape.xy * reach;
    diffuse = shading.y * vec3(dot(x, light), dot(y, light), dot(z, light));
    specular = vec3(dot(x, h), dot(y, h), dot(z, h));
    float silhouette = radius * wide * sqrt(d2 / inside2);
    gl_Position = projectionMatrix * vec4(center + silhouette * (x * place.x + y * place.y), 1.0);
#ifdef SOLID
    depth = center.z;
    bulge = radius;
#endif
}

void bar(vec3 from, vec3 end, vec3 h) {
    float radius = barRadius * shape.w / 100.0;
    if (from.z > -radius || end.z > -radius) return;
    // n is the normal of the plane through the eye and the bar's axis. The silhouette of the bar runs parallel to the
    // axis.
    vec3 axis = end - from, n = cross(from, end);
    float n2 = dot(n, n), axis2 = dot(axis, axis), inside2 = n2 - radius * radius * axis2;
    if (inside2 <= 0.0) return;
    float wide = widen(radius * pixels / (-0.5 * (from.z + end.z)), false), reach = sqrt(1.0 + 0.5 / place.z);
    vec3 x = n / sqrt(n2), z = cross(x, axis) / sqrt(axis2);
    if (dot(z, from) > 0.0) z = -z;
    place.xy = vec2(shape.x * reach, 0.0);
    diffuse = shading.y * vec3(dot(x, light), 0.0, dot(z, light));
    specular = vec3(dot(x, h), 0.0, dot(z, h));
    vec3 side = x * (place.x * radius * wide * sqrt(n2 / inside2));
    vec3 corner = (shape.y < 0.0 ? from : end) + side;
#ifndef SOLID
    // A bar is drawn over the ball at its far end, where it has a round foot: the half of the circle at this end that
    // faces the eye. The patch extends to the end of the foot in the picture. v is 0 at the far end of the bar, and
    // grows to the end of the patch.
    bool fromIsFar = from.z < end.z;
    vec3 far = fromIsFar ? from : end, along = (fromIsFar ? axis : -axis) / sqrt(axis2);
    float rise = radius * reach, extension = dot(far, along) * rise / (dot(far, z) + rise);
    if (extension > 0.001 * rise && dot(far, z) + rise < 0.0 && 2.0 * place.z >= kMinFootRadius) {
        bool isFar = (shape.y < 0.0) == fromIsFar;
        place.y = isFar ? reach : -reach * sqrt(axis2) / extension;
        if (isFar) corner -= extension * along;
    }
#endif
    gl_Position = projectionMatrix * vec4(corner, 1.0);
#ifdef SOLID
    depth = (shape.y < 0.0 ? from : end).z;
    bulge = radius * z.z;
#endif
}

void main() {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // outside the clip volume, unless set below
    place = diffuse = specular = vec3(0.0);
#ifdef SOLID
    depth = -1.0;
    bulge = 0.0;
#endif
    alpha = 1.0;
    leastV = shape.z == ${kBall}.0 ? -2.0 : 0.0;
    tint = color.rgb;
    vec3 h = normalize(light + vec3(0.0, 0.0, 1.0));
    vec3 seen = (viewMatrix * vec4(at, 1.0)).xyz;
    if (color.a == 0.0 && shape.z != ${kFace}.0) return;
    if (shape.z == ${kBall}.0) {
        ball(seen, ballRadius * to.x, h);
    } else if (shape.z == ${kBar}.0) {
        bar(seen, (viewMatrix * vec4(to, 1.0)).xyz, h);
    } else {
        place.z = 0.5;
        diffuse.z = shading.y * abs(dot(mat3(viewMatrix) * to, light));
        gl_Position = projectionMatrix * vec4(seen, 1.0);
#ifdef SOLID
        depth = seen.z;
#endif
    }
    alpha *= color.a;
}
`;

export const fragmentShader = `
precision highp float;
uniform vec4 shading;
in vec3 place;
flat in vec3 diffuse, specular, tint;
flat in float alpha, leastV;
#ifdef SOLID
uniform mat4 projectionMatrix;
in float depth;
flat in float bulge;
#endif
out vec4 pixel;
void main() {
    vec2 uv = vec2(place.x, max(place.y, leastV));
    float q = 1.0 - dot(uv, uv);
    vec3 n = vec3(uv, sqrt(max(q, 0.0)));
    float shine = shading.z * pow(max(dot(n, specular), 0.0), shading.w);
    vec3 lit = tint * (shading.x + max(dot(n, diffuse), 0.0)) + shine;
    pixel = vec4(lit, alpha * clamp(q * place.z + 0.5, 0.0, 1.0));
#ifdef SOLID
    float z = depth + bulge * n.z;
    gl_FragDepth = 0.5 - 0.5 * (projectionMatrix[2].z * z + projectionMatrix[3].z) / z;
#endif
}
`;
