// What the pages take of three.js: both load one bundle of it.

export {
  AlwaysStencilFunc, BufferAttribute, BufferGeometry, DataTexture, DataUtils, DoubleSide, GLSL3, GreaterDepth, Group,
  InvertStencilOp, LatheGeometry, LineSegments, MathUtils, Matrix4, MOUSE, Mesh, NearestFilter, NotEqualStencilFunc,
  OrthographicCamera, PlaneGeometry, RGBAFormat, Ray, Raycaster, Scene, ShaderMaterial, TOUCH, Triangle, UnsignedByteType,
  Vector2, Vector3, Vector4, WebGLRenderTarget, WebGLRenderer, ZeroStencilOp,
} from "three";
export type { Box3, Material, Object3D, ShaderMaterialParameters } from "three";
export { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
export { MeshBVH } from "three-mesh-bvh";
