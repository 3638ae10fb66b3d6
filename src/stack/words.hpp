#pragma once

/// The choices a stack document offers by name. The same words serve the command line.

#include <surfgrad/worley.hpp>

#include <array>
#include <string_view>

namespace surfgrad::stack {

/// How a layer joins the sum of its pass. With w = mask * opacity:
/// add: G += w * scale * g. mix: G = (1 - w) * G + w * scale * g, in document order.
enum class Blend { add, mix };
/// What lies outside the unit square of a map.
enum class Wrap { repeat, mirror, clamp };
enum class Filter { nearest, bilinear, trilinear };
/// Which channels of a normal map hold the vector. xy reconstructs z from the unit length; automatic
/// is xy for a two-channel file or one of constant blue, else xyz.
enum class Channels { automatic, xyz, xy };
/// What the texels of a projected map are: tangent-space normals, slopes, or heights.
enum class Content { normal, derivative, height };
/// Which code of an 8-bit derivative map means flat: 127.5, so that the codes span the range evenly and
/// none is exactly flat, or the whole code 128, as signed formats have it (32767.5 and 32768 of 16 bits).
enum class NeutralCode { between, whole };
/// Whether the green channel of a normal map points along +t (up) or against it.
enum class Green { up, down };
/// The frame a tangent-space normal map was made for: MikkTSpace at the vertices, or the frame derived
/// per fragment from the texture coordinate.
enum class Basis { mikktspace, derived };
enum class Space { object, world };
/// What a surface seen from behind shows. same: the front's normal; mirror: the interpolated normal
/// negated; flip: that, and the bumps negated too; cull: nothing.
enum class BackFaces { same, mirror, flip, cull };
enum class MaskChannel { r, g, b, a };
/// Functions of space: three noises, and three ways to sum octaves of one.
enum class NoiseKind { perlin, simplex, worley, fractal_sum, turbulence, ridged };
enum class NoiseBasis { perlin, simplex, worley };
/// surface_gradient: the gradient's part along the surface; perlin1985: the whole gradient added to the
/// normal, as Perlin did in 1985, to compare with.
enum class NoiseMethod { surface_gradient, perlin1985 };

/// Where a subdivision puts the vertex in the middle of an edge: halfway, or on a curve that leaves both
/// ends perpendicular to their normals.
enum class Edges { straight, curved };

template <class E>
struct Word {
  std::string_view text;
  E value;
};

/// The words of an enumeration, in the order in which messages list them. Channels::automatic has
/// none: it is what a document says by leaving the key out.
template <class E>
inline constexpr auto words_of = nullptr;

template <>
inline constexpr auto words_of<Blend> = std::to_array<Word<Blend>>({{"add", Blend::add},
                                                                    {"mix", Blend::mix}});
template <>
inline constexpr auto words_of<Wrap> =
    std::to_array<Word<Wrap>>({{"repeat", Wrap::repeat}, {"mirror", Wrap::mirror}, {"clamp", Wrap::clamp}});
template <>
inline constexpr auto words_of<Filter> = std::to_array<Word<Filter>>({{"nearest", Filter::nearest},
                                                                      {"bilinear", Filter::bilinear},
                                                                      {"trilinear", Filter::trilinear}});
template <>
inline constexpr auto words_of<Channels> = std::to_array<Word<Channels>>({{"xyz", Channels::xyz},
                                                                          {"xy", Channels::xy}});
template <>
inline constexpr auto words_of<Content> = std::to_array<Word<Content>>({{"normal", Content::normal},
                                                                        {"derivative", Content::derivative},
                                                                        {"height", Content::height}});
template <>
inline constexpr auto words_of<NeutralCode> =
    std::to_array<Word<NeutralCode>>({{"between", NeutralCode::between}, {"whole", NeutralCode::whole}});
template <>
inline constexpr auto words_of<Green> = std::to_array<Word<Green>>({{"up", Green::up},
                                                                    {"down", Green::down}});
template <>
inline constexpr auto words_of<Basis> = std::to_array<Word<Basis>>({{"mikktspace", Basis::mikktspace},
                                                                    {"derived", Basis::derived}});
template <>
inline constexpr auto words_of<Space> = std::to_array<Word<Space>>({{"object", Space::object},
                                                                    {"world", Space::world}});
template <>
inline constexpr auto words_of<BackFaces> = std::to_array<Word<BackFaces>>({{"same", BackFaces::same},
                                                                            {"mirror", BackFaces::mirror},
                                                                            {"flip", BackFaces::flip},
                                                                            {"cull", BackFaces::cull}});
template <>
inline constexpr auto words_of<MaskChannel> = std::to_array<Word<MaskChannel>>(
    {{"r", MaskChannel::r}, {"g", MaskChannel::g}, {"b", MaskChannel::b}, {"a", MaskChannel::a}});
template <>
inline constexpr auto words_of<Edges> = std::to_array<Word<Edges>>({{"straight", Edges::straight},
                                                                    {"curved", Edges::curved}});
template <>
inline constexpr auto
    words_of<NoiseKind> = std::to_array<Word<NoiseKind>>({{"perlin", NoiseKind::perlin},
                                                          {"simplex", NoiseKind::simplex},
                                                          {"worley", NoiseKind::worley},
                                                          {"fractal_sum", NoiseKind::fractal_sum},
                                                          {"turbulence", NoiseKind::turbulence},
                                                          {"ridged", NoiseKind::ridged}});
template <>
inline constexpr auto words_of<NoiseBasis> = std::to_array<Word<NoiseBasis>>(
    {{"perlin", NoiseBasis::perlin}, {"simplex", NoiseBasis::simplex}, {"worley", NoiseBasis::worley}});
template <>
inline constexpr auto words_of<NoiseMethod> = std::to_array<Word<NoiseMethod>>(
    {{"surface_gradient", NoiseMethod::surface_gradient}, {"perlin1985", NoiseMethod::perlin1985}});
template <>
inline constexpr auto words_of<WorleyKind> =
    std::to_array<Word<WorleyKind>>({{"f1", WorleyKind::f1}, {"f2_minus_f1", WorleyKind::f2_minus_f1}});

} // namespace surfgrad::stack
